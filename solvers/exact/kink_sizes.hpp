#pragma once
/// KinkSizes: how strongly the kinks of a step act, and how strongly a motion of their rows acts back, for all of them at once.
#include <limits>
#include <vector>

#include "solvers/exact/lane_table.hpp"
#include "solvers/exact/tangent_load.hpp"

namespace drev {

class KinkSizes {
 public:
  void clear() { count_ = 0; }
  int count() const { return static_cast<int>(count_); }
  /// A kink of a load whose angle comes over the knot at a rate that stays within kMonotone of `rate`, by s [rad]. Over the turn behind
  /// it its force is bounded by chord times the turn, and by slope times the angle's change [N m/rad].
  void add(const PlacedLoad& load, double rate, double chord, double slope) {
    if (count_ == table_.room()) make_room();
    const std::size_t room = table_.room();
    loads_[count_] = &load;
    double* to = table_.at(0) + count_++;
    to[kReach * room] = load.reach;
    to[kPush * room] = load.push;
    to[kFeedback * room] = load.turn;
    to[kRate * room] = rate;
    to[kChord * room] = chord;
    to[kSlope * room] = slope;
  }
  static constexpr double kMonotone = 0.25;
  /// Finds what follows, over a step of h [s].
  void find(double h);
  const PlacedLoad& load_of(int i) const { return *loads_[static_cast<std::size_t>(i)]; }
  /// |d/ds| of the acceleration that the kink sets in [1/s^2], in whole lanes with zeros behind the last one.
  const double* pull() const { return table_.at(kPull); }
  /// Of what a motion of its row turns, the acceleration that comes back [1/s^2].
  const double* gain() const { return table_.at(kGain); }
  double most_pull() const { return most_pull_; }
  double most_gain() const { return most_gain_; }
  /// How fast a row turns the angle at least, by s [rad or m]: infinity where none does.
  double least_rate() const { return least_rate_; }
  /// Bound of the accelerations of all of them, sum |jump theta'| h^2/sqrt(m): energies tell that they move an unknown of
  /// mass m over s by no more than this s^3/(6 sqrt(m)).
  double push() const { return push_; }

 private:
  enum Quantity { kReach, kPush, kFeedback, kRate, kChord, kSlope, kPull, kGain, kQuantities };
  struct Find;
  void make_room();

  std::vector<const PlacedLoad*> loads_;
  std::size_t count_ = 0;
  LaneTable<kQuantities> table_;
  double most_pull_ = 0.0, most_gain_ = 0.0, push_ = 0.0;
  double least_rate_ = std::numeric_limits<double>::infinity();
};

}  // namespace drev
