#include <drev/core/element.hpp>
#include <drev/core/scalar_force.hpp>
#include <drev/solvers/modes/damped_modes.hpp>

#include "core/element_parts.hpp"
#include "solvers/linear/complex_stiffnesses.hpp"

namespace drev {

namespace {

using Shares = Eigen::MatrixXd;

/// Of each mode x' A x over some nodes.
Eigen::RowVectorXd forms(const Eigen::MatrixXd& a, const Eigen::MatrixXcd& x) {
  return (x.conjugate().cwiseProduct(a * x)).colwise().sum().real();
}

void normalise(Shares& shares) {
  for (Eigen::Index j = 0; j < shares.cols(); ++j) {
    const double sum = shares.col(j).sum();
    if (sum > 0.0) shares.col(j) /= sum;
  }
}

/// What k* of elements is beyond their matrices, at the frequency of each mode.
void add_complex_stiffnesses(const System& system, const DampedModeSet& modes, ModeEnergy& energy) {
  const std::vector<FrequencyTerm>& terms = system.frequency_terms();
  const ComplexStiffnesses stiffnesses(system);
  for (std::size_t t = 0; t < terms.size(); ++t)
    for (Eigen::Index j = 0; j < modes.shapes.cols(); ++j) {
      std::complex<double> deflection = 0.0;
      for (const Entry& e : terms[t].nodes) deflection += e.coeff * modes.shapes(e.index, j);
      const double omega = modes.modes[static_cast<std::size_t>(j)].lambda.imag(),
                   square = std::norm(deflection);
      const std::complex<double> k = stiffnesses.beyond(t, omega, terms[t].stiffness->load_in_matrices());
      energy.elastic(index(terms[t].element), j) += k.real() * square;
      energy.dissipated(index(terms[t].element), j) += k.imag() / omega * square;
    }
}

}  // namespace

ModeEnergy mode_energy(const System& system, const DampedModeSet& modes) {
  const std::vector<ElementInstance>& instances = system.element_instances();
  const auto count = static_cast<Eigen::Index>(instances.size()), columns = modes.shapes.cols();
  ModeEnergy energy;
  energy.kinetic = energy.elastic = energy.dissipated = Shares::Zero(count, columns);
  // What Rayleigh damping is proportional to, and its factors, element by element.
  Eigen::RowVectorXd mass = Eigen::RowVectorXd::Zero(columns), stiffness = mass;
  std::vector<std::pair<double, double>> rayleigh(instances.size());
  ElementParts parts;
  for (std::size_t e = 0; e < instances.size(); ++e) {
    const auto row = static_cast<Eigen::Index>(e);
    std::vector<int> nodes;
    for (const NodeRef& ref : instances[e].nodes) nodes.push_back(system.node_of(ref));
    for (const NodeId id : instances[e].internal) nodes.push_back(index(id));
    parts.for_each(*instances[e].element, nodes, [&](const Terms& terms, const std::vector<int>& of_part) {
      const Eigen::MatrixXcd x = modes.shapes(of_part, Eigen::all);
      const Eigen::RowVectorXd kinetic = forms(terms.mass, x), elastic = forms(terms.stiffness, x);
      energy.kinetic.row(row) += kinetic;
      energy.elastic.row(row) += elastic;
      energy.dissipated.row(row) += forms(terms.damping, x);
      if (terms.deviation_damping.size() > 0) energy.dissipated.row(row) += forms(terms.deviation_damping, x);
      if (terms.rayleigh) mass += kinetic, stiffness += elastic;
      rayleigh[e].first += terms.rayleigh_a;
      rayleigh[e].second += terms.rayleigh_b;
      for (const ScalarSpec& scalar : terms.scalars) {
        if (modes.contact == Contact::open && scalar.force->gap()) continue;
        const Eigen::RowVectorXd squares = (scalar.b.transpose() * x).cwiseAbs2();
        energy.elastic.row(row) += scalar.force->closed_stiffness() * squares;
        energy.dissipated.row(row) += scalar.force->closed_damping() * squares;
      }
    });
  }
  if (!modes.in_time) add_complex_stiffnesses(system, modes, energy);
  for (std::size_t e = 0; e < instances.size(); ++e)
    energy.dissipated.row(static_cast<Eigen::Index>(e)) +=
        rayleigh[e].first * mass + rayleigh[e].second * stiffness;

  std::vector<Eigen::Index> kept;
  for (Eigen::Index e = 0; e < count; ++e) {
    if (energy.kinetic.row(e).isZero(0.0) && energy.elastic.row(e).isZero(0.0) &&
        energy.dissipated.row(e).isZero(0.0))
      continue;
    kept.push_back(e);
    energy.elements.push_back(instances[static_cast<std::size_t>(e)].name);
  }
  for (Shares* shares : {&energy.kinetic, &energy.elastic, &energy.dissipated}) {
    *shares = (*shares)(kept, Eigen::all).eval();
    normalise(*shares);
  }
  return energy;
}

}  // namespace drev
