// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "drivers/dialogue.h"
#include "drivers/obsdaq_settings.h"

/// start_up() is the conversation that brings an ObsDAQ from any state into streaming with the host's
/// settings: quick stop, silence, identity, serial number, trigger off, three channels, trigger, start; each
/// echo checked. Behind a PalmAcq, first into its transparent mode, at last into forwarding.
///
/// What a device does not answer needs a pause, and how long nobody has written down: the scripts of the
/// MARTAS project wait for one line of reply or 2 s. So the pauses are short at first, and what they lead to
/// is checked by the echoes and by the first valid line; where they lead to nothing the conversation is held
/// again with long ones. The second after the trigger is off is never shortened: what comes of a shorter one,
/// no echo would tell.
///
///                                brisk          patient
///   pause after a command        0.02 s         0.2 to 0.3 s
///   silence that ends a drain    0.1 s          0.3 s
///   an echo is waited for        2 x 0.4 s      3 x 2 s
///   in all, without its answers  1.2 s          1.5 s      directly
///                                1.4 s          3.7 s      behind a PalmAcq
namespace mgtd::drivers::obsdaq {

enum class Patience { brisk, patient };

[[nodiscard]] Dialogue start_up(const ObsdaqSettings& settings, Patience patience);

}  // namespace mgtd::drivers::obsdaq
