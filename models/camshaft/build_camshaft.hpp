#pragma once
/// The camshaft of a four-stroke marine diesel, 6 to 10 cylinders (S. L. Sunde, NTNU, 2015, figure 3.1), on
/// reconstructed data (camshaft_data.hpp):
///
///   gear - journal_1 - fuel_1 - exhaust_1 - inlet_1 - journal_2 - ... - inlet_N - end
///
/// Cylinder k's cams run at -360 j/N degrees, j its place in the firing order counted from 0. Drive: gears
/// (the two-stage gear drive, crank gear at constant speed), held (the camshaft's gear at constant speed), or
/// free (nothing held: for free-free modes).
#include <drev/models/model_case.hpp>

namespace drev {

struct CamshaftParams {
  int cylinders = 9;                   ///< 6 to 10
  std::vector<int> firing_order = {};  ///< empty: the default one
  bool twist_feedback = true;          ///< false: the source's loads, at the nominal angle
  double rayleigh_a = 0.0;             ///< 1/s
  double rayleigh_b = 0.0;             ///< s
};

/// Adds the shaft from node "gear" to node "end" with its loads; nothing is prescribed.
void add_camshaft(Model& model, const CamshaftParams& params);

ModelCase build_camshaft(Parameters parameters);
const ModelEntry& camshaft_entry();

}  // namespace drev
