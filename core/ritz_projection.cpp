#include <drev/core/error.hpp>
#include <drev/core/load.hpp>
#include <drev/core/ritz_projection.hpp>

#include <algorithm>
#include <limits>

#include "core/dense/factorization.hpp"

namespace drev {

namespace {

constexpr double kRounding = 16 * std::numeric_limits<double>::epsilon();

/// Column of a row's only entry; -1 where it has more.
int only_entry(const Eigen::MatrixXd& basis, int row) {
  int found = -1;
  for (int k = 0; k < basis.cols(); ++k) {
    if (basis(row, k) == 0.0) continue;
    if (found >= 0) return -1;
    found = k;
  }
  return found;
}

SparseMatrix on_pattern(SparseMatrix pattern, const Vector& values) {
  std::copy(values.begin(), values.end(), pattern.valuePtr());
  return pattern;
}

/// B' A B without what is below its rounding.
Eigen::MatrixXd projected(const SparseMatrix& a, const Eigen::MatrixXd& basis) {
  const Eigen::MatrixXd small = basis.transpose() * (a * basis);
  const Eigen::MatrixXd sizes = basis.cwiseAbs().transpose() * (a.cwiseAbs() * basis.cwiseAbs());
  return (small.array().abs() > kRounding * sizes.array()).select(0.5 * (small + small.transpose()), 0.0);
}

SparseMatrix couplings(const SparseMatrix& a, const Eigen::MatrixXd& basis) {
  return Eigen::MatrixXd(basis.transpose() * a).sparseView();
}

}  // namespace

class RitzProjector {
 public:
  RitzProjector(const System& full, const Eigen::MatrixXd& basis)
      : full_(full), basis_(basis), system_(full) {}

  System project() {
    check_basis();
    map_nodes();
    check_generals();
    map_terms();
    assemble();
    set_vectors();
    return std::move(system_);
  }

  static System hold(const System& full, const std::vector<bool>& held, const Vector& damping,
                     const Vector& stiffness) {
    System system = full;
    std::vector<int> place(held.size(), -1), kept;
    for (std::size_t k = 0; k < held.size(); ++k)
      if (!held[k]) place[k] = static_cast<int>(kept.size()), kept.push_back(static_cast<int>(k));
    const auto count = static_cast<Eigen::Index>(kept.size()), known = full.zu_.mass.cols();
    std::vector<Eigen::Triplet<double>> entries, ones;
    std::vector<int> slots;
    for (int j = 0; j < full.size(); ++j)
      for (int s = full.pattern().outerIndexPtr()[j]; s < full.pattern().outerIndexPtr()[j + 1]; ++s)
        if (const int i = full.pattern().innerIndexPtr()[s]; !held[idx(i)] && !held[idx(j)])
          entries.emplace_back(place[idx(i)], place[idx(j)], 0.0), slots.push_back(s);
    const auto pattern = std::make_shared<SparseMatrix>(count, count);
    pattern->setFromTriplets(entries.begin(), entries.end());
    system.pattern_ = pattern;
    system.mass_ = full.mass_(slots);
    system.damping_ = full.damping_(slots);
    system.stiffness_ = full.stiffness_(slots);
    if (damping.size() > 0) system.damping_ += damping(slots);
    if (stiffness.size() > 0) system.stiffness_ += stiffness(slots);
    for (std::size_t k = 0; k < kept.size(); ++k) ones.emplace_back(static_cast<int>(k), kept[k], 1.0);
    SparseMatrix rows_kept(count, full.size());
    rows_kept.setFromTriplets(ones.begin(), ones.end());
    for (SparseMatrix* columns : {&system.zu_.mass, &system.zu_.damping, &system.zu_.stiffness})
      *columns = (rows_kept * *columns).eval();
    for (NodeMap& map : system.node_map_)
      if (map.unknown >= 0) map.unknown = place[idx(map.unknown)];
    system.rows_ = full.rows_(Eigen::all, kept);
    for (ScalarTerm& term : system.scalars_)
      for (Entry& e : term.z) e.index = place[idx(e.index)];
    for (VaryingInertiaRow& row : system.varying_inertias_) row.unknown = place[idx(row.unknown)];
    system.frequency_terms_.clear();
    system.unknown_node_.clear();
    for (const int k : kept) system.unknown_node_.push_back(full.unknown_node_[idx(k)]);
    for (Vector* x : {&system.initial_z_, &system.initial_v_, &system.nominal_direction_})
      *x = (*x)(kept).eval();
    for (Vector* m : {&system.nominal_inertia_, &system.nominal_drag_}) {
      Vector of_kept(count + known);
      of_kept << (*m)(kept), m->tail(known);
      *m = std::move(of_kept);
    }
    place_terms(system);
    return system;
  }

 private:
  int count() const { return static_cast<int>(basis_.cols()); }

  /// Finds the places of terms and loads in a pattern and in unknowns that are new.
  static void place_terms(System& system) {
    system.find_slots();
    system.table_loads_ = {};
    system.knotted_loads_ = {};
    system.moving_loads_.clear();
    system.known_loads_.clear();
    for (int i = 0; i < static_cast<int>(system.loads_.size()); ++i) system.map_load(i);
  }

  void check_basis() const {
    std::vector<Finding> findings;
    if (basis_.rows() != full_.size() || basis_.cols() < 1 || basis_.cols() > basis_.rows())
      findings.push_back({full_.name(), "basis",
                          std::to_string(basis_.rows()) + " x " + std::to_string(basis_.cols()), "",
                          "must have a row for each of the " + std::to_string(full_.size()) +
                              " unknowns, and at least one column but no more than rows"});
    else if (!basis_.allFinite())
      findings.push_back({full_.name(), "basis", "not finite", "", "must be finite"});
    if (const auto why =
            full_.why_not_varying_inertia("a train with a rigid planetary set, or a reduced one,"))
      findings.push_back({full_.name(), "system", "", "", *why});
    if (full_.rows().rows() > 0)
      findings.push_back({full_.name(), "system", "", "", "is a projected one already"});
    if (!findings.empty()) throw ModelError(findings);
  }

  /// A row with one entry is a coordinate; the others are rows, those with loads first.
  void map_nodes() {
    std::vector<int> row_of(idx(full_.size()), -1), rows;
    const auto give_row = [&](int unknown) {
      int& row = row_of[idx(unknown)];
      if (row >= 0) return;
      row = static_cast<int>(rows.size());
      rows.push_back(unknown);
    };
    std::vector<int> single(idx(full_.size()));
    for (int i = 0; i < full_.size(); ++i) single[idx(i)] = only_entry(basis_, i);
    const auto unknown_of = [&](int node) {
      const int i = full_.node_map(node).unknown;
      return i >= 0 && single[idx(i)] < 0 ? i : -1;
    };
    for (const LoadTerm& l : full_.loads())
      if (const int i = unknown_of(l.node); i >= 0) give_row(i);
    system_.loaded_rows_ = static_cast<int>(rows.size());
    for (int node = 0; node < full_.node_count(); ++node)
      if (const int i = unknown_of(node); i >= 0) give_row(i);
    system_.rows_.resize(static_cast<Eigen::Index>(rows.size()), count());
    for (std::size_t r = 0; r < rows.size(); ++r)
      system_.rows_.row(static_cast<Eigen::Index>(r)) = basis_.row(rows[r]);
    for (NodeMap& map : system_.node_map_) {
      const int i = map.unknown;
      if (i < 0) continue;
      const int k = single[idx(i)];
      if (k < 0)
        map = {.coeff = map.coeff, .row = row_of[idx(i)]};
      else
        map = {.unknown = k, .coeff = map.coeff * basis_(i, k)};
    }
    system_.unknown_node_.resize(idx(count()));
    for (int k = 0; k < count(); ++k) {
      Eigen::Index largest = 0;
      basis_.col(k).cwiseAbs().maxCoeff(&largest);
      const auto own = std::find(single.begin(), single.end(), k);
      if (own != single.end()) largest = own - single.begin();
      system_.unknown_node_[idx(k)] = full_.unknown_node_[static_cast<std::size_t>(largest)];
    }
  }

  void check_generals() const {
    std::vector<Finding> findings;
    for (const GeneralTerm& g : full_.generals())
      for (const int node : g.nodes)
        if (system_.node_map(node).row >= 0)
          findings.push_back({full_.name(), "general element",
                              full_.element_instances()[idx(index(g.element))].name, "",
                              "needs node " + full_.node_names()[idx(node)] + " as a coordinate: keep it"});
    if (!findings.empty()) throw ModelError(findings);
  }

  void map_terms() {
    for (ScalarTerm& term : system_.scalars_) {
      Vector row = Vector::Zero(count());
      for (const Entry& e : term.z) row += e.coeff * basis_.row(e.index).transpose();
      term.z.clear();
      for (int k = 0; k < count(); ++k)
        if (row[k] != 0.0) term.z.push_back({k, row[k]});
    }
    for (FrequencyTerm& term : system_.frequency_terms_) {
      Vector row = Vector::Zero(count());
      for (const Entry& e : term.z) row += e.coeff * basis_.row(e.index).transpose();
      term.z.clear();
      for (int k = 0; k < count(); ++k)
        if (row[k] != 0.0) term.z.push_back({k, row[k]});
    }
  }

  void assemble() {
    const SparseMatrix& p = full_.pattern();
    const Eigen::MatrixXd matrices[3] = {projected(on_pattern(p, full_.mass_values()), basis_),
                                         projected(on_pattern(p, full_.damping_values()), basis_),
                                         projected(on_pattern(p, full_.stiffness_values()), basis_)};
    Eigen::MatrixXd used = Eigen::MatrixXd::Identity(count(), count());
    for (const Eigen::MatrixXd& m : matrices) used += m.cwiseAbs();
    const auto couple = [&](int i, int j) { used(i, j) = 1.0; };
    for (const ScalarTerm& term : system_.scalars_)
      for (const Entry& r : term.z)
        for (const Entry& c : term.z) couple(r.index, c.index);
    for (const GeneralTerm& g : system_.generals_)
      for (const int i : g.nodes)
        for (const int j : g.nodes)
          if (system_.node_map(i).unknown >= 0 && system_.node_map(j).unknown >= 0)
            couple(system_.node_map(i).unknown, system_.node_map(j).unknown);
    // The slope of a load on a row couples all.
    for (const LoadTerm& l : system_.loads_)
      if (l.load->depends_on_motion() && system_.node_map(l.node).row >= 0) used.setOnes();
    const auto pattern = std::make_shared<SparseMatrix>(used.sparseView(0.0, 0.0));
    pattern->makeCompressed();
    Vector* const values[3] = {&system_.mass_, &system_.damping_, &system_.stiffness_};
    for (int which = 0; which < 3; ++which) {
      values[which]->resize(pattern->nonZeros());
      for (int j = 0, s = 0; j < count(); ++j)
        for (; s < pattern->outerIndexPtr()[j + 1]; ++s)
          (*values[which])[s] = matrices[which](pattern->innerIndexPtr()[s], j);
    }
    std::fill_n(pattern->valuePtr(), pattern->nonZeros(), 0.0);
    system_.pattern_ = pattern;
    system_.zu_ = {couplings(full_.zu_.mass, basis_), couplings(full_.zu_.damping, basis_),
                   couplings(full_.zu_.stiffness, basis_)};
    place_terms(system_);
    mass_ = matrices[0];
  }

  void set_vectors() {
    const CholeskyFactor mass(mass_);
    if (!mass.positive_definite())
      throw ModelError({{full_.name(), "basis", "dependent columns", "",
                         "must have linearly independent columns, each moving an inertia"}});
    const SparseMatrix full_mass = on_pattern(full_.pattern(), full_.mass_values());
    const auto nearest = [&](const Vector& z) -> Vector {
      return mass.solve(Vector(basis_.transpose() * (full_mass * z)));
    };
    system_.initial_z_ = nearest(full_.initial_z_);
    system_.initial_v_ = nearest(full_.initial_v_);
    system_.nominal_direction_ = nearest(full_.nominal_direction_);
    const auto of_unknowns = [&](const Vector& m) {
      const Eigen::Index known = full_.prescribed_count();
      Vector out(count() + known);
      out << basis_.transpose() * m.head(full_.size()), m.tail(known);
      return out;
    };
    system_.nominal_inertia_ = of_unknowns(full_.nominal_inertia_);
    system_.nominal_drag_ = of_unknowns(full_.nominal_drag_);
  }

  const System& full_;
  const Eigen::MatrixXd& basis_;
  System system_;
  Eigen::MatrixXd mass_;
};

System ritz_projection(const System& system, const Eigen::MatrixXd& basis) {
  return RitzProjector(system, basis).project();
}

System held_system(const System& system, const std::vector<bool>& held, const Vector& damping,
                   const Vector& stiffness) {
  return RitzProjector::hold(system, held, damping, stiffness);
}

}  // namespace drev
