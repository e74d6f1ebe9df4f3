// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/things/placing.h"

#include <algorithm>
#include <numbers>
#include <tuple>

namespace vdbmap::simulator {
namespace {

constexpr double kWinterShare = 0.3;   // of the epochs
constexpr double kClearance = 0.4;     // [m] between two things of a zone
constexpr double kFreeWidth = 1.1;     // [m] of a pavement that stays open
constexpr int kTries = 4;              // places tried for a thing
constexpr double kFromDriveway = 0.5;  // [m]

// A stretch that something takes in some epochs.
struct Taken {
  Zone zone;
  Interval stretch;
  int epoch;
};

bool cars_stand_on_pavement(const SideLayout& side) {
  return side.parking == ParkingKind::kHalfOnPavement || side.parking == ParkingKind::kOnPavement;
}

double free_pavement(const SideLayout& side) {
  if (side.parking == ParkingKind::kHalfOnPavement) return side.pavement_width - 1.0;
  return side.parking == ParkingKind::kOnPavement ? side.pavement_width - 2.3 : side.pavement_width;
}

// Places the things of one side.
class SidePlacer {
 public:
  SidePlacer(World& world, const StreetLayout& layout, std::size_t street, std::size_t side, const Parking& parking,
             std::vector<PlacedThing>& things)
      : world_(world),
        layout_(layout),
        street_(street),
        index_(side),
        side_(layout.sides[side]),
        parking_(parking),
        things_(things) {}

  // The kind's things of one epoch, or of all (-1).
  void place(const ThingKind& kind, int epoch, std::uint64_t seed) {
    Random random(seed);
    const double mean = kind.per_100m * (layout_.end() - layout_.begin()) / 100;
    const int count = static_cast<int>(mean * random.uniform(0.4, 1.6) + random.uniform(0, 1));
    for (int i = 0; i < count; ++i) {
      Random of_thing(random.seed());
      for (int attempt = 0; attempt < kTries && !place_one(kind, epoch, of_thing); ++attempt) {
      }
    }
  }

 private:
  bool place_one(const ThingKind& kind, int epoch, Random& random) {
    if (kind.zone == Zone::kOnSpace) return place_on_space(kind, epoch, random);
    const double station = random.uniform(layout_.begin() + 3, layout_.end() - 3);
    const Interval stretch = {station - kind.length / 2, station + kind.length / 2};
    const std::optional<double> distance = distance_of(kind, stretch, random);
    if (!distance || !take(kind.zone, stretch, epoch)) return false;
    append(kind, layout_.place_on_side(side_, station, *distance), epoch, random, std::nullopt);
    return true;
  }

  // From the axis, or nothing where the thing has no room.
  std::optional<double> distance_of(const ThingKind& kind, const Interval& stretch, Random& random) const {
    const bool is_narrow = free_pavement(side_) - kind.width < kFreeWidth;
    switch (kind.zone) {
      case Zone::kAtKerb:
        if (is_narrow || !side_.is_plain(stretch, kFromDriveway)) return std::nullopt;
        return cars_stand_on_pavement(side_) ? side_.pavement_offset() - kind.width / 2 - 0.1
                                             : side_.kerb_offset() + 0.3 + kind.width / 2;
      case Zone::kAtGardens:
        if (is_narrow || !side_.is_plain(stretch, kFromDriveway)) return std::nullopt;
        return side_.pavement_offset() - 0.15 - kind.width / 2;
      case Zone::kInGarden:
        if (side_.garden_depth < kind.width + 0.4 || !side_.is_plain(stretch, 0.3)) return std::nullopt;
        return side_.pavement_offset() + 0.2 + kind.width / 2 +
               random.uniform(0, side_.garden_depth - kind.width - 0.4);
      default:
        return facade_distance(kind, stretch);
    }
  }

  // The wall of the house before which the whole stretch lies.
  std::optional<double> facade_distance(const ThingKind& kind, const Interval& stretch) const {
    for (const Lot& lot : side_.lots) {
      if (lot.kind != LotKind::kHouse || stretch.begin < lot.along.begin || stretch.end > lot.along.end) continue;
      const double wall = side_.facade_offset() + side_.house_types[lot.house_type].stand_back;
      return kind.width > 0.5 ? wall - 0.5 : wall;
    }
    return std::nullopt;
  }

  bool take(Zone zone, const Interval& stretch, int epoch) {
    const bool is_taken = std::ranges::any_of(taken_, [&](const Taken& other) {
      const bool meets_in_time = epoch < 0 || other.epoch < 0 || epoch == other.epoch;
      return other.zone == zone && meets_in_time && other.stretch.meets(stretch, kClearance);
    });
    if (!is_taken) taken_.push_back({zone, stretch, epoch});
    return !is_taken;
  }

  // A space along the kerb that is long enough and vacant.
  bool place_on_space(const ThingKind& kind, int epoch, Random& random) {
    if (parking_.spaces.empty()) return false;
    const std::size_t index = random.index(parking_.spaces.size());
    const ParkingSpace& space = parking_.spaces[index];
    if (space.street != street_ || space.side != index_ || space.length < kind.length ||
        space.width < kind.width - 0.4 || space.in_car_park)
      return false;
    if (parking_.vehicle_in_space[static_cast<std::size_t>(epoch)][index]) return false;
    const Interval stretch = {space.station - space.length / 2, space.station + space.length / 2};
    if (!take(Zone::kOnSpace, stretch, epoch)) return false;
    const Eigen::Isometry3d frame = layout_.place(space.station, side_.sign * space.distance, space.yaw);
    append(kind, frame, epoch, random, index);
    return true;
  }

  void append(const ThingKind& kind, const Eigen::Isometry3d& frame, int epoch, Random& random,
              std::optional<std::size_t> space) {
    Eigen::Isometry3d turned = frame;
    if (kind.label == SurfaceClass::kPerson) {
      turned.rotate(Eigen::AngleAxisd(random.uniform(0, 2 * std::numbers::pi), Eigen::Vector3d::UnitZ()));
    }
    const ObjectId object = world_.add_object({kind.name, turned.translation(), epoch});
    things_.push_back({&kind, turned, object, random.seed(), epoch, space});
  }

  World& world_;
  const StreetLayout& layout_;
  std::size_t street_;
  std::size_t index_;
  const SideLayout& side_;
  const Parking& parking_;
  std::vector<PlacedThing>& things_;
  std::vector<Taken> taken_;
};

void draw_thing(World& world, Mesh& mesh, const PlacedThing& thing, bool is_winter) {
  Random random(thing.seed);
  const Brush brush{&mesh, thing.scene_from_thing, world.standard().stone, thing.object};
  thing.kind->draw({brush, world, random, thing.kind->length, thing.kind->width, is_winter});
}

}  // namespace

std::vector<PlacedThing> place_things(World& world, const StreetLayout& layout, std::size_t street,
                                      const Parking& parking, const StreetOptions& options, std::uint64_t seed) {
  std::vector<PlacedThing> things;
  for (const std::size_t side : {0, 1}) {
    SidePlacer placer(world, layout, street, side, parking, things);
    const auto kinds = thing_kinds();
    // What stands there for years comes first, so that days find their places around it.
    for (const Stay stay : {Stay::kYears, Stay::kDay}) {
      for (std::size_t k = 0; k < kinds.size(); ++k) {
        if (kinds[k].stay != stay) continue;
        const std::uint64_t of_kind = hash(hash(seed, 301 + side), k);
        if (stay == Stay::kYears) placer.place(kinds[k], -1, of_kind);
        for (int epoch = 0; stay == Stay::kDay && epoch < options.num_epochs; ++epoch) {
          if (kinds[k].season == Season::kWinter && !is_winter(options, epoch)) continue;
          placer.place(kinds[k], epoch, hash(of_kind, static_cast<std::uint64_t>(epoch)));
        }
      }
    }
  }
  return things;
}

void draw_lasting_things(World& world, Mesh& mesh, const std::vector<PlacedThing>& things) {
  for (const PlacedThing& thing : things) {
    if (thing.epoch < 0 && thing.kind->season != Season::kSheds) draw_thing(world, mesh, thing, false);
  }
}

void draw_changing_things(World& world, Mesh& mesh, const std::vector<PlacedThing>& things, int epoch, bool is_winter) {
  for (const PlacedThing& thing : things) {
    const bool sheds = thing.epoch < 0 && thing.kind->season == Season::kSheds;
    if (sheds || thing.epoch == epoch) draw_thing(world, mesh, thing, is_winter);
  }
}

bool is_winter(const StreetOptions& options, int epoch) {
  if (options.is_ideal) return false;
  return unit_interval(hash(hash(options.seed, 62), static_cast<std::uint64_t>(epoch))) < kWinterShare;
}

}  // namespace vdbmap::simulator
