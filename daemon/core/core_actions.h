// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include <string_view>

#include "daemon/run/run_actions.h"
#include "proto/epoch.h"
#include "proto/input_value.h"
#include "proto/raw_log.h"
#include "proto/slot.h"
#include "proto/tensor.h"

/// CoreActions lists everything that the core can ask for: the daemon does it on ports, disk and sockets,
/// tests do it in memory.
namespace mgtd::daemon::core {

/// A line for the operator's log.
struct Remark {
  enum class Level { info, warning } level{Level::info};
  /// What repeats about one topic ("s2") is written now and then only; empty: written always.
  std::string topic;
  std::string text;
};

class CoreActions {
 public:
  CoreActions() = default;
  CoreActions(const CoreActions&) = delete;
  CoreActions& operator=(const CoreActions&) = delete;
  virtual ~CoreActions() = default;

  /// Bytes to the port of an instrument.
  virtual void send(Slot slot, std::string_view bytes) = 0;
  /// Into the journal of raw bytes; `record` is valid during the call only.
  virtual void record(const RawRecord& record) = 0;
  /// One sample of the stream, the epoch it was made from, and what the rig measures beside the field.
  virtual void publish(const Epoch& epoch, const TensorSample& sample,
                       std::span<const InputValue> inputs) = 0;
  virtual void publish(const Gap& gap) = 0;
  /// What the run asks for; but its orders to the table, which the core gives itself. Answers go to
  /// DaemonCore::run().
  virtual void carry_out(const run::Action& action, Stamp now) = 0;
  virtual void say(const Remark& remark, Instant now) = 0;
};

}  // namespace mgtd::daemon::core
