#pragma once
/// The energy balance of a run, of one or of kLanes variants, as energy_monitor.hpp keeps it:
///
///   kinetic + stored - start = input - dissipated + imbalance
#include <drev/core/lanes.hpp>

#include <limits>

namespace drev {

/// J, the thermal energy k T at 293 K: no balance is off by less, since trains that stand still move so by rounding alone.
inline constexpr double kNoEnergy = 4e-21;

/// Number: double, or LaneRow for a number of each lane's.
template <class Number>
struct Balance {
  Number start{};            ///< J, kinetic and stored at the start
  Number kinetic{};          ///< J, at the end
  Number stored{};           ///< J, at the end
  Number input{};            ///< J, since the start
  Number dissipated{};       ///< J, since the start
  Number imbalance{};        ///< J, at the end: > 0 energy from nothing
  Number worst_imbalance{};  ///< J, largest in size over the run
  Number worst_time{};       ///< s
  Number given{};            ///< J, largest of |input|, |dissipated| and the start's energy over the run
  Number scale{};            ///< J, largest of input, dissipated, kinetic + |stored| over the run
};

struct EnergyBalance : Balance<double> {
  /// J, kNoEnergy or more: rounding of the energy that shafts store by the difference of angles as large as those at the start.
  double rounding = kNoEnergy;
  /// worst_imbalance over scale [-]; 0 for a run whose energy is rounding.
  double relative_error() const { return scale > rounding ? worst_imbalance / scale : 0.0; }
};

/// Enters a step that ends at t [s]: what is kinetic and stored there, what was put in and what dissipated
/// since the start [J]. Only where `good`, which is cleared where the imbalance is not finite. Value and
/// Mask: double and bool, or Lanes and LaneMask.
template <class Number, class Value, class Mask>
[[gnu::always_inline]] inline void enter_step(Balance<Number>& b, const Value& kinetic, const Value& stored,
                                              const Value& input, const Value& dissipated, double t,
                                              Mask& good) {
  const Value energy = kinetic + stored;
  const Value imbalance = energy - each(b.start) - input + dissipated;
  Value size = imbalance, worst = each(b.worst_imbalance), put_in = input, lost = dissipated;
  // What a law dissipates is below zero where it drives, as one does that states no energy.
  magnitude(size), magnitude(worst), magnitude(put_in), magnitude(lost);
  good &= size <= std::numeric_limits<double>::max();
  Value given = each(b.given) < put_in ? put_in : each(b.given);
  given = given < lost ? lost : given;
  Value scale = each(b.scale) < given ? given : each(b.scale);
  // A law's own energy may be below zero (a coupling that snaps through).
  Value held = stored;
  magnitude(held);
  held = kinetic + held;
  scale = scale < held ? held : scale;
  const Mask worse = good & (size > worst);
  put_where(worse, imbalance, each(b.worst_imbalance));
  put_where(worse, Value{} + t, each(b.worst_time));
  put_where(good, kinetic, each(b.kinetic));
  put_where(good, stored, each(b.stored));
  put_where(good, input, each(b.input));
  put_where(good, dissipated, each(b.dissipated));
  put_where(good, imbalance, each(b.imbalance));
  put_where(good, given, each(b.given));
  put_where(good, scale, each(b.scale));
}

}  // namespace drev
