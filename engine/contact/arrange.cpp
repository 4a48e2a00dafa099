#include "engine/contact/arrange.h"

#include <bit>
#include <utility>

#include "engine/bytes_of.h"

namespace weft {

using kernels::kLanes;

void Arrangement::arrange(const ContactPoints& points, NearPairs& near) {
  order_.clear();
  used_in_.resize(points.unmoved_point(), 0);
  for (const bool turned : {false, true}) {
    for (const bool likely : {true, false}) {
      for (std::uint32_t i = 0; i < near.list.size(); ++i) {
        if (near.list.is_used(i) && near.has(i, near.turned) == turned &&
            near.has(i, near.likely) == likely)
          place(points, near, i);
      }
      while (are_open_ != 0) close(near, static_cast<std::uint32_t>(std::countr_zero(are_open_)));
    }
  }
  spare_.take(near, order_, points.unmoved_point());
  std::swap(near, spare_);
}

/// Into the first block that moves none of its points.
void Arrangement::place(const ContactPoints& points, const NearPairs& near, std::uint32_t pair) {
  std::uint64_t taken = 0;
  const auto four = near.list.points(pair);
  for (const std::uint32_t point : four) {
    if (points.inverse_mass(point) > 0) taken |= used_in_[point];
  }
  if ((are_open_ & ~taken) == 0) {
    if (~are_open_ == 0) close(near, 0);
    const std::uint32_t opened = open();
    taken &= ~(std::uint64_t{1} << opened);
  }
  const auto at = static_cast<std::uint32_t>(std::countr_zero(are_open_ & ~taken));
  Block& block = blocks_[at];
  order_[block.first + block.count++] = pair;
  for (const std::uint32_t point : four) {
    if (points.inverse_mass(point) > 0) used_in_[point] |= std::uint64_t{1} << at;
  }
  if (block.count == kLanes) close(near, at);
}

std::uint32_t Arrangement::open() {
  const auto at = static_cast<std::uint32_t>(std::countr_one(are_open_));
  are_open_ |= std::uint64_t{1} << at;
  blocks_[at] = {order_.size(), 0};
  order_.resize(order_.size() + kLanes, kNoIndex);
  return at;
}

void Arrangement::close(const NearPairs& near, std::uint32_t block) {
  const auto& [first, count] = blocks_[block];
  for (std::size_t i = first; i < first + count; ++i) {
    for (const std::uint32_t point : near.list.points(order_[i]))
      used_in_[point] &= ~(std::uint64_t{1} << block);
  }
  are_open_ &= ~(std::uint64_t{1} << block);
}

std::size_t Arrangement::bytes() const {
  return bytes_of(order_) + bytes_of(used_in_) + spare_.bytes();
}

}  // namespace weft
