#pragma once
/// A study of many variants of one model, with a row of figures kept for each variant: its description, and
/// the computation of a block of variants.
///
/// Blocks and their rows are the same for any number of processes and threads. The variants of a block with
/// constant steps are computed in lockstep (drev/solvers/batch/simulate_many.hpp) if they have the same
/// topology and duration, otherwise one by one.
#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/base/json_values.hpp"
#include "app/run/run_request.hpp"
#include "app/variants/variant_plan.hpp"
#include "app/variants/variant_store.hpp"

namespace drev {
struct VariantResult;
}  // namespace drev

namespace drev::app {

/// Status of a variant as a number of its row.
enum class VariantStatus {
  success,
  energy_error,
  unstable,
  no_convergence,
  not_finite,
  failed,
  bad_input  ///< the parameters are invalid
};
inline constexpr int kVariantStatuses = 7;
const char* status_text(VariantStatus status);

struct FigureColumn {
  std::string name, unit;
};

/// The figures of a model's variants; channels: those recorded that have columns, as find_channels() takes them.
std::vector<FigureColumn> figure_columns(const ModelCase& model_case, const System& system,
                                         const std::vector<std::string>& channels);

class VariantStudy {
 public:
  /// request: request for the first variant; record_asked: true if its recorded channels were requested and
  /// so have columns.
  VariantStudy(RunRequest request, VariantPlan plan, bool record_asked);

  const RunRequest& request() const { return request_; }
  const VariantPlan& plan() const { return plan_; }
  /// The figures in the order of a row, where they follow the status.
  const std::vector<FigureColumn>& figures() const { return figures_; }
  std::size_t row_size() const { return 1 + figures_.size(); }

  std::uint64_t block_size() const { return block_size_; }  ///< variants in a block
  std::uint64_t blocks() const { return (plan_.count() + block_size_ - 1) / block_size_; }
  std::uint64_t first_of(std::uint64_t block) const { return block * block_size_; }
  /// Number of variants in a block; the last block may have fewer.
  std::uint64_t count_of(std::uint64_t block) const {
    return std::min(block_size_, plan_.count() - first_of(block));
  }
  StoreShape store_shape() const { return {blocks(), block_size_ * row_size()}; }
  /// Why variants run one by one; empty: in lockstep.
  const std::string& why_not_lockstep() const { return why_not_lockstep_; }

  /// Everything that its rows depend on, as JSON: model and files with checksums, parameters, method, and so
  /// on.
  const Json& description() const { return description_; }

  /// The rows of a block; nullopt if go_on returned false. May be called by several threads at once.
  std::optional<BlockRows> run(std::uint64_t block, const std::function<bool()>& go_on) const;
  /// The row of a variant, which need not be in the plan.
  std::optional<BlockRows> run_one(const ParameterValues& values, const std::function<bool()>& go_on) const;

 private:
  struct Built;
  struct Watched;
  void describe();
  Built build(const ParameterValues& values) const;
  void run_together(std::vector<Built>& built, std::uint64_t block, std::size_t first, std::size_t count,
                    const std::function<bool()>& go_on, BlockRows& rows) const;
  void enter(const Built& built, const VariantResult& result, std::size_t place, BlockRows& rows) const;

  std::shared_ptr<const Watched> watched_by(const ModelCase& model_case, const System& system) const;

  RunRequest request_;
  VariantPlan plan_;
  std::shared_ptr<const Watched> watched_;  // channels of the first variant
  std::vector<std::string> channels_;       // recorded channels that have columns
  std::vector<FigureColumn> figures_;
  std::uint64_t block_size_ = 1;
  std::string why_not_lockstep_;
  Json description_;
};

/// The differences between two descriptions, one sentence each; empty: there are none.
std::vector<std::string> differences(const Json& then, const Json& now);

}  // namespace drev::app
