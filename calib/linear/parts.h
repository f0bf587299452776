// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <functional>

/// for_each_part() does work on two processors, in parts that do not need each other.
///
/// A part writes only what belongs to it, and the caller puts together what the parts have made, in their
/// order: the digits of a result do not depend on how many threads there are. The threads end with the call.
namespace mgtd::calib::linear {

/// Threads that parts are given to: within a part one, else as many as the processors that this process may
/// use (`taskset` narrows them), and no more than two, since each holds matrices of its own. Where the
/// address space is bounded (RLIMIT_AS), one for each 500 MB of it: OpenBLAS takes 128 MB of it for each
/// thread, and where it gets none it asks again without end.
[[nodiscard]] std::size_t threads();

/// Calls `work` with 0, 1, ... count - 1, each once, in any order, from several threads; returns when all are
/// done. Called within a part, it does them one after the other, in their order. Throws what a part throws,
/// after the parts that had begun; further ones are not begun.
void for_each_part(std::size_t count, const std::function<void(std::size_t)>& work);

/// From now on the thread that calls does all its parts itself.
void keep_parts_on_this_thread();

/// The same with the poses of a run: part i are those from `from` on, before `to`. Up to 1024 poses are one
/// part.
void for_each_poses(std::size_t poses,
                    const std::function<void(std::size_t part, std::size_t from, std::size_t to)>& work);
[[nodiscard]] std::size_t parts_of_poses(std::size_t poses);

}  // namespace mgtd::calib::linear
