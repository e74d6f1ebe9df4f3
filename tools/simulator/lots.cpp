// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/lots.h"

#include <algorithm>
#include <array>

namespace vdbmap::simulator {
namespace {

constexpr double kDrivewayShare = 0.4;                // of the gaps between rows of houses
constexpr double kSideStreetWidth = 8.5;              // [m]
constexpr double kShortestStreetWithSideStreet = 80;  // [m]

std::size_t row_length(Housing housing, Random& random) {
  if (housing == Housing::kTerraced) return 3 + random.index(3);
  return housing == Housing::kBlock ? 2 + random.index(3) : 1;
}

// Where a side street begins; beyond the end where there is none.
double side_street_begin(const SideLayout& side, const Interval& stretch, double street_length, Random& random) {
  const double share = side.sign > 0 ? random.uniform(0.2, 0.45) : random.uniform(0.55, 0.8);
  return street_length < kShortestStreetWithSideStreet ? stretch.end + 1 : share * street_length;
}

class LotRow {
 public:
  LotRow(const SideLayout& side, const Interval& stretch, double side_street, double special_share, Random& random)
      : side_(side),
        stretch_(stretch),
        side_street_(side_street),
        special_share_(special_share),
        random_(random),
        station_(stretch.begin) {}

  std::vector<Lot> make() {
    while (station_ < stretch_.end) {
      if (station_ >= side_street_) {
        append(LotKind::kSideStreet, kSideStreetWidth, 0);
        side_street_ = stretch_.end + 1;
      }
      append_row();
      append_gap();
      if (special_share_ > 0 && random_.chance(special_share_)) append_special();
    }
    return lots_;
  }

 private:
  // Houses of one type, up to the side street.
  void append_row() {
    const std::size_t type = random_.index(side_.house_types.size());
    const std::size_t count = row_length(side_.housing, random_);
    for (std::size_t i = 0; i < count && station_ < std::min(side_street_, stretch_.end); ++i) {
      append(LotKind::kHouse, side_.house_types[type].width, type);
    }
  }

  // Not every gap is wide enough for a car.
  void append_gap() {
    const bool has_driveway = random_.chance(kDrivewayShare);
    const double width = has_driveway ? random_.uniform(3.0, side_.housing == Housing::kDetached ? 4.8 : 3.6)
                                      : random_.uniform(1.4, 3.0);
    append(has_driveway ? LotKind::kDriveway : LotKind::kGap, width, 0);
  }

  // Something else than houses, where the side street leaves room.
  void append_special() {
    constexpr std::array<LotKind, 4> kKinds = {LotKind::kPark, LotKind::kCarPark, LotKind::kHall, LotKind::kOpen};
    const LotKind kind = kKinds[random_.index(kKinds.size())];
    const double length = kind == LotKind::kOpen ? random_.uniform(25, 55) : random_.uniform(20, 40);
    const double room = (station_ < side_street_ ? std::min(side_street_, stretch_.end) : stretch_.end) - station_;
    if (room >= length) append(kind, length, 0);
  }

  void append(LotKind kind, double length, std::size_t type) {
    lots_.push_back({kind, {station_, station_ + length}, type, random_.seed()});
    station_ += length;
  }

  const SideLayout& side_;
  Interval stretch_;
  double side_street_;
  double special_share_;
  Random& random_;
  double station_;
  std::vector<Lot> lots_;
};

}  // namespace

std::vector<Lot> make_lots(const SideLayout& side, const Interval& stretch, double street_length, Random& random) {
  const double side_street = side_street_begin(side, stretch, street_length, random);
  return LotRow(side, stretch, side_street, 0, random).make();
}

std::vector<Lot> make_rough_lots(const SideLayout& side, const Interval& stretch, const LotPlan& plan, Random& random) {
  return LotRow(side, stretch, plan.side_street.value_or(stretch.end + 1), plan.special_share, random).make();
}

}  // namespace vdbmap::simulator
