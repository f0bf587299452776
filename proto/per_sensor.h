// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <boost/container/static_vector.hpp>
#include <cstddef>
#include <initializer_list>

/// PerSensor holds one value for each sensor of the array, in the order s1, s2, ...
namespace mgtd {

inline constexpr int kSensors = 4;  ///< of the cross, the array that is meant where none is described
inline constexpr auto kSensorCount = static_cast<std::size_t>(kSensors);  ///< for what counts in sizes
inline constexpr int kMostSensors = 16;  ///< that an array can have: all storage is bounded by it

/// A vector whose storage lies in the object itself, so that nothing is allocated while samples stream.
/// Constructed without arguments it holds the sensors of the cross. Its values begin as T{}, and vectors and
/// matrices of Eigen, which T{} leaves unset, as zero. Throws std::bad_alloc beyond kMostSensors.
template <class T>
class PerSensor : public boost::container::static_vector<T, static_cast<std::size_t>(kMostSensors)> {
  using Base = boost::container::static_vector<T, static_cast<std::size_t>(kMostSensors)>;

 public:
  PerSensor() : PerSensor(kSensorCount) {}
  PerSensor(std::initializer_list<T> values) : Base(values) {}
  explicit PerSensor(std::size_t sensors) : Base(sensors) {
    if constexpr (requires {
                    requires T::SizeAtCompileTime >
                    0;
                  })
      fill(T::Zero());
  }
  PerSensor(std::size_t sensors, const T& value) : Base(sensors, value) {}
  void fill(const T& value) { this->assign(this->size(), value); }
};

}  // namespace mgtd
