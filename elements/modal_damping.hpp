#pragma once
/// ModalDamping: a damping ratio for each elastic mode of the whole train.
///
///   C = sum_j 2 xi_j omega_j (M phi_j)(M phi_j)',     M phi_j' phi_j = 1,     j the elastic modes, contacts closed
///
/// It acts on deviations: the nominal motion and rigid-body motion lose nothing by it. Where nothing else damps, mode j
/// then has the damping ratio xi_j exactly, and modes are not coupled. C belongs to the whole train and is dense: only
/// add_modal_damping() (models/modal_damping.hpp) and a model file's modal_damping make it, over the train as it
/// is built there; couplings with a loss factor count by their chain.
/// Source: R. W. Clough, J. Penzien, Dynamics of Structures, 2nd ed., McGraw-Hill, 1993, section 12-5 (damping matrix
/// of modal damping ratios).
#include <drev/core/element_interface.hpp>
#include <drev/elements/not_given.hpp>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

namespace drev {

class ModalDamping final : public Element {
 public:
  struct Params {
    double ratio = kNotGiven;  ///< xi of all elastic modes [-], 0 to 1; or
    std::vector<double> ratios =
        {};  ///< of elastic modes 1, 2, ..., the last for all further ones [-], 0 to 1
  };
  /// damping: C over the element's nodes [N m s/rad].
  explicit ModalDamping(Params params, Eigen::MatrixXd damping = {})
      : params_(std::move(params)), damping_(std::move(damping)) {}

  const Params& params() const { return params_; }
  const Eigen::MatrixXd& damping() const { return damping_; }
  double ratio_of(std::size_t mode) const {
    return params_.ratios.empty() ? params_.ratio : params_.ratios[std::min(mode, params_.ratios.size() - 1)];
  }
  std::string_view type() const override { return "modal damping"; }
  int min_nodes() const override { return static_cast<int>(damping_.rows()); }
  bool mixes_kinds() const override { return true; }
  void check(ParameterCheck& check) const override;
  void describe(int nodes, Terms& terms) const override;

 private:
  Params params_;
  Eigen::MatrixXd damping_;
};

}  // namespace drev
