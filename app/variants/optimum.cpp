#include "app/variants/optimum.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <memory>
#include <nlopt.h>
#include <numeric>
#include <type_traits>

#include "app/base/text_layout.hpp"
#include "app/variants/block_threads.hpp"
#include "app/variants/optimum_pace.hpp"

namespace drev::app {

namespace {

constexpr double kLastPart = 0.25;        // part of the variants for continuous parameters besides others [-]
constexpr double kLocalTolerance = 1e-6;  // tolerance of a local search relative to a parameter's range [-]
constexpr double kFirstStep = 0.1;        // first step relative to a parameter's range [-]
constexpr std::size_t kStarts = 16;       // largest number of local searches
// Calls of NLopt allowed for each variant: most points of values and orders have been computed before.
constexpr std::uint64_t kCallsPerVariant = 100;

struct DestroyOpt {
  void operator()(nlopt_opt search) const { nlopt_destroy(search); }
};
using NloptSearch = std::unique_ptr<std::remove_pointer_t<nlopt_opt>, DestroyOpt>;

class OptimumSearch {
 public:
  OptimumSearch(const VariantStudy& study, const OptimumOptions& options)
      : study_(study),
        options_(options),
        by_size_(study.figures()[options.figure].name == "energy_error"),
        most_(study.plan().sampling() ? options.variants : study.plan().count()),
        pace_(study.plan().sampling() ? study.plan().count() : 0, most_,
              study.block_size() > 1 ? 0 : options.threads) {
    for (const Varied& v : study.plan().varied())
      coordinates_ += v.kind == Varied::Kind::orders ? static_cast<std::size_t>(v.items) - 1 : 1;
  }

  Optimum run() {
    compute_plan();
    if (study_.plan().sampling() && !result_.interrupted) {
      nlopt_srand(static_cast<unsigned long>(options_.seed));
      if (has(false)) search_values();
      if (has(true)) search_locally();
    }
    result_.all = !study_.plan().sampling() && !result_.interrupted;
    result_.order = ranked();
    return std::move(result_);
  }

 private:
  /// Whether any parameter is continuous (or, for false, any is not).
  bool has(bool continuous) const {
    const auto& varied = study_.plan().varied();
    return std::any_of(varied.begin(), varied.end(),
                       [&](const Varied& v) { return (v.count() == 0) == continuous; });
  }

  bool tell() {
    if (options_.go_on && !options_.go_on(pace_.part_done(computed_))) result_.interrupted = true;
    return !result_.interrupted;
  }

  void enter(const ParameterValues& values, const BlockRows& rows, std::size_t i) {
    known_.emplace(key_of(values), result_.tried.size());
    const double* row = rows.numbers.data() + i * study_.row_size();
    result_.tried.push_back({values, static_cast<VariantStatus>(static_cast<int>(row[0])), rows.reason(i),
                             row[1 + options_.figure]});
  }

  static std::string key_of(const ParameterValues& values) {
    std::string key;
    for (const auto& [name, value] : values) key += value + ";";
    return key;
  }

  /// Computes all variants of the plan with threads, and enters them in their order.
  void compute_plan() {
    std::map<std::uint64_t, BlockRows> waiting;
    BlockThreads threads(study_, options_.threads);
    std::uint64_t given = 0, entered = 0;
    while (entered < study_.blocks() && tell()) {
      while (given < study_.blocks() && threads.wants_more()) threads.give({given++, 1});
      for (FoundBlock& found : threads.take(std::chrono::milliseconds(20)))
        computed_ += study_.count_of(found.block), waiting.emplace(found.block, std::move(found.rows));
      for (auto next = waiting.find(entered); next != waiting.end(); next = waiting.find(entered)) {
        for (std::uint64_t i = 0; i < study_.count_of(entered); ++i)
          if (const ParameterValues values = study_.plan().parameters(study_.first_of(entered) + i);
              !known_.contains(key_of(values)))
            enter(values, next->second, i);
        waiting.erase(next);
        ++entered;
      }
    }
  }

  double cost(const TriedVariant& tried) const {
    const double figure = by_size_ ? std::abs(tried.figure) : tried.figure;
    return options_.largest ? -figure : figure;
  }

  std::vector<std::size_t> ranked() const {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < result_.tried.size(); ++i)
      if (std::isfinite(result_.tried[i].figure) && result_.tried[i].status == VariantStatus::success)
        order.push_back(i);
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return cost(result_.tried[a]) < cost(result_.tried[b]);
    });
    return order;
  }

  ParameterValues values_at(const double* u) const {
    ParameterValues values;
    for (const Varied& v : study_.plan().varied()) {
      if (v.kind == Varied::Kind::uniform) {
        values.emplace_back(v.name, v.between(*u++));
      } else if (v.kind == Varied::Kind::values) {
        const auto count = static_cast<double>(v.count());
        values.emplace_back(v.name, v.value(static_cast<std::uint64_t>(std::min(count - 1.0, *u++ * count))));
      } else {
        std::vector<int> items(static_cast<std::size_t>(v.items) - 1);
        std::iota(items.begin(), items.end(), 2);
        std::stable_sort(items.begin(), items.end(), [u](int a, int b) { return u[a - 2] < u[b - 2]; });
        std::string text = "1";
        for (const int item : items) text += "-" + std::to_string(item);
        values.emplace_back(v.name, std::move(text));
        u += items.size();
      }
    }
    return values;
  }

  /// A point of the unit cube that has these values.
  std::vector<double> point_of(const ParameterValues& values) const {
    std::vector<double> u;
    for (std::size_t p = 0; p < values.size(); ++p) {
      const Varied& v = study_.plan().varied()[p];
      const std::string& text = values[p].second;
      if (v.kind == Varied::Kind::uniform) {
        double value = v.first;
        read_number(text, value);
        u.push_back(std::clamp((value - v.first) / (v.second - v.first), 0.0, 1.0));
      } else if (v.kind == Varied::Kind::values) {
        const auto at = std::find(v.values.begin(), v.values.end(), text) - v.values.begin();
        u.push_back((static_cast<double>(at) + 0.5) / static_cast<double>(v.count()));
      } else {
        const std::vector<std::string> order = split(text, '-');
        const std::size_t first = u.size();
        u.resize(first + order.size() - 1);
        for (std::size_t k = 1; k < order.size(); ++k)
          u[first + static_cast<std::size_t>(std::stoi(order[k])) - 2] =
              (static_cast<double>(k) - 0.5) / static_cast<double>(order.size() - 1);
      }
    }
    return u;
  }

  /// The value of a variant without a figure: worse than all others.
  double worst() const {
    double worst = -HUGE_VAL;
    for (const TriedVariant& tried : result_.tried)
      if (std::isfinite(tried.figure)) worst = std::max(worst, cost(tried));
    return std::isfinite(worst) ? worst + std::abs(worst) : 1.0;
  }

  double cost_at(const double* u) {
    const ParameterValues values = values_at(u);
    const std::string key = key_of(values);
    if (!known_.contains(key)) {
      const auto rows = tell() && result_.tried.size() < limit_
                            ? study_.run_one(values, [this] { return tell(); })
                            : std::nullopt;
      if (!rows) {
        nlopt_force_stop(search_);
        return worst();
      }
      ++computed_;
      enter(values, *rows, 0);
    }
    const TriedVariant& tried = result_.tried[known_.at(key)];
    return std::isfinite(tried.figure) && tried.status == VariantStatus::success ? cost(tried) : worst();
  }

  /// One search over some of the coordinates from a point, with the others fixed. It ends at limit_ variants.
  void search(nlopt_algorithm algorithm, const std::vector<double>& from,
              const std::vector<std::size_t>& free) {
    point_ = from;
    free_ = free;
    const NloptSearch made(nlopt_create(algorithm, static_cast<unsigned>(free.size())));
    search_ = made.get();
    nlopt_set_lower_bounds1(search_, 0.0);
    nlopt_set_upper_bounds1(search_, 1.0);
    nlopt_set_xtol_abs1(search_, kLocalTolerance);
    nlopt_set_initial_step1(search_, kFirstStep);
    const std::uint64_t left = limit_ > result_.tried.size() ? limit_ - result_.tried.size() : 1;
    nlopt_set_maxeval(search_, static_cast<int>(kCallsPerVariant * left));
    nlopt_set_min_objective(
        search_,
        [](unsigned, const double* x, double*, void* data) {
          auto& self = *static_cast<OptimumSearch*>(data);
          for (std::size_t i = 0; i < self.free_.size(); ++i) self.point_[self.free_[i]] = x[i];
          try {
            return self.cost_at(self.point_.data());
          } catch (...) {
            self.failure_ = std::current_exception();  // no exception may pass through NLopt, which is C
            nlopt_force_stop(self.search_);
            return 0.0;
          }
        },
        this);
    std::vector<double> x;
    for (const std::size_t i : free) x.push_back(from[i]);
    double found = 0.0;
    nlopt_optimize(search_, x.data(), &found);
    search_ = nullptr;
    if (failure_) std::rethrow_exception(failure_);
  }

  std::vector<std::size_t> coordinates(bool continuous_only) const {
    std::vector<std::size_t> all;
    std::size_t at = 0;
    for (const Varied& v : study_.plan().varied()) {
      const std::size_t size = v.kind == Varied::Kind::orders ? static_cast<std::size_t>(v.items) - 1 : 1;
      for (std::size_t i = 0; i < size; ++i, ++at)
        if (!continuous_only || v.count() == 0) all.push_back(at);
    }
    return all;
  }

  void search_values() {
    const double part = has(true) ? 1.0 - kLastPart : 1.0;
    limit_ = static_cast<std::uint64_t>(part * static_cast<double>(most_));
    const std::vector<std::size_t> best = ranked();
    search(NLOPT_GN_ESCH,
           best.empty() ? std::vector<double>(coordinates_, 0.5) : point_of(result_.tried[best[0]].values),
           coordinates(false));
  }

  void search_locally() {
    limit_ = most_;
    const std::vector<std::size_t> starts = ranked();
    for (std::size_t i = 0; i < std::min(kStarts, starts.size()); ++i) {
      if (result_.tried.size() >= limit_ || result_.interrupted) return;
      search(NLOPT_LN_SBPLX, point_of(result_.tried[starts[i]].values), coordinates(true));
    }
  }

  const VariantStudy& study_;
  const OptimumOptions& options_;
  bool by_size_;  // an error's sign says whether energy was lost or made, not how good it is
  std::uint64_t most_, limit_ = 0, computed_ = 0;
  OptimumPace pace_;
  std::size_t coordinates_ = 0;
  Optimum result_;
  std::map<std::string, std::size_t> known_;  // numbers in result_.tried
  nlopt_opt search_ = nullptr;
  std::vector<double> point_;
  std::vector<std::size_t> free_;
  std::exception_ptr failure_;
};

}  // namespace

Optimum find_optimum(const VariantStudy& study, const OptimumOptions& options) {
  return OptimumSearch(study, options).run();
}

std::uint64_t first_sample(std::uint64_t variants) { return std::max<std::uint64_t>(1, variants / 4); }

}  // namespace drev::app
