#pragma once
/// LaneTable: quantities of many items, each quantity in whole lanes one item behind the other.
#include <drev/core/lanes.hpp>

#include <algorithm>
#include <cstddef>

namespace drev {

template <int kQuantities>
class LaneTable {
 public:
  std::size_t room() const { return room_; }
  double* at(int quantity) { return values_.data() + static_cast<std::size_t>(quantity) * room_; }
  const double* at(int quantity) const { return values_.data() + static_cast<std::size_t>(quantity) * room_; }
  /// Room for kLanes more items, whose quantities are 0.
  void make_room() {
    const std::size_t more = room_ + kLanes;
    LaneVector values(kQuantities * more);
    for (int q = 0; q < kQuantities; ++q)
      std::copy_n(at(q), room_, values.data() + static_cast<std::size_t>(q) * more);
    values_ = std::move(values);
    room_ = more;
  }

 private:
  std::size_t room_ = 0;
  LaneVector values_;
};

}  // namespace drev
