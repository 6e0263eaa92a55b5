#pragma once
/// ElementTotals: what each element of a train gave, lost and held at most over a run (channels of channel.hpp):
///
///   work         integral of power_W                    J, > 0: it drove the train
///   dissipated   integral of dissipation_W              J
///   stored       largest stored_J, located inside steps  J
///
/// After the first point integrals are those of ChannelValues; of dry friction the contact's own heat.
#include <drev/solvers/run/channel_values.hpp>
#include <drev/solvers/run/peaks.hpp>

#include <optional>
#include <string>
#include <vector>

namespace drev {

class ElementTotals final : public Observer {
 public:
  struct Row {
    std::string element;
    std::optional<double> work, dissipated;  ///< J; none: the element has no such channel
    std::optional<double> largest_stored;    ///< J
    double length = 0.0;                     ///< s, of what was watched
    /// Mean power that it turned into heat [W].
    std::optional<double> mean_loss() const {
      if (!dissipated || !(length > 0.0)) return {};
      return *dissipated / length;
    }
  };

  explicit ElementTotals(const System& system);
  bool fits(const System& system) const override {
    return are_of(system, values_.channels()) && stored_.fits(system);
  }
  void look_through(StepMotion& motion) override;
  void start(const Assembler& assembler, const EvaluatedState& point) override;
  void step(const Assembler& assembler, const EvaluatedState& from, const EvaluatedState& to) override;
  void restart(const Assembler& assembler, const EvaluatedState& point) override;
  bool needs_acceleration() const override;
  bool watches_loads() const override;

  /// In the order of the elements; of those that have any.
  std::vector<Row> rows() const;

 private:
  ChannelValues values_;
  Peaks stored_;
  std::vector<double> begin_, last_;  // integrals of values_' channels
  double t_begin_ = 0.0, t_last_ = 0.0;
};

}  // namespace drev
