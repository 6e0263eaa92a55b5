#include <drev/core/element.hpp>
#include <drev/core/error.hpp>
#include <drev/solvers/batch/simulate_many.hpp>
#include <drev/solvers/exact/exact_propagation.hpp>

#include <algorithm>
#include <atomic>
#include <map>
#include <mutex>
#include <optional>

#include "solvers/batch/lockstep.hpp"
#include "solvers/run/for_all.hpp"
#include "solvers/run/stiff_twists.hpp"

namespace drev {

namespace {

/// What all variants have in common.
class Topology {
 public:
  explicit Topology(const System& s)
      : nodes_(s.node_names()),
        outer_(s.pattern().outerIndexPtr(), s.pattern().outerIndexPtr() + s.size() + 1),
        inner_(s.pattern().innerIndexPtr(), s.pattern().innerIndexPtr() + s.pattern().nonZeros()) {
    for (const ElementInstance& p : s.element_instances()) elements_.push_back(describe(p));
    for (const ScalarTerm& t : s.scalars()) terms_.emplace(index(t.element), entries(t));
    for (int i = 0; i < s.node_count(); ++i) places_.push_back(place(s, i));
  }

  /// How a system differs; empty: not at all.
  std::string difference(const System& other) const {
    const Topology t(other);
    if (t.nodes_ != nodes_) return "its nodes are not those of variant 0";
    for (std::size_t i = 0; i < std::min(elements_.size(), t.elements_.size()); ++i)
      if (t.elements_[i] != elements_[i])
        return "has " + t.elements_[i] + " where variant 0 has " + elements_[i];
    if (t.elements_.size() != elements_.size())
      return "has " + std::to_string(t.elements_.size()) + " elements, variant 0 has " +
             std::to_string(elements_.size());
    for (std::size_t i = 0; i < places_.size(); ++i)
      if (t.places_[i] != places_[i])
        return "node " + nodes_[i] + " is tied or prescribed otherwise than in variant 0";
    // A law of the one may be a straight line of the other's, and then is no term.
    const bool same = t.outer_ == outer_ && t.inner_ == inner_ &&
                      std::all_of(t.terms_.begin(), t.terms_.end(), [this](const auto& term) {
                        const auto own = terms_.equal_range(term.first);
                        return own.first == own.second ||
                               std::any_of(own.first, own.second, [&](const auto& x) { return x == term; });
                      });
    return same ? "" : "its elements connect other nodes than in variant 0";
  }

 private:
  static std::string describe(const ElementInstance& p) {
    return std::string(p.element->type()) + " '" + p.name + "'";
  }
  static std::vector<int> entries(const ScalarTerm& t) {
    std::vector<int> all{t.phase_node, static_cast<int>(t.z.size())};
    for (const Entry& e : t.z) all.push_back(e.index);
    for (const Entry& e : t.u) all.push_back(e.index);
    return all;
  }
  static std::pair<int, int> place(const System& s, int node) {
    const NodeMap& map = s.node_map(node);
    return {map.unknown, map.prescribed};
  }

  std::vector<std::string> nodes_, elements_;
  std::vector<int> outer_, inner_;
  std::multimap<int, std::vector<int>> terms_;  // terms of each element
  std::vector<std::pair<int, int>> places_;
};

/// Hands out the variants to threads, block by block, and gathers what they leave.
class Many {
 public:
  using Progress = std::function<bool(double)>;
  /// Runs the systems given, some of a block; go_on as in Lockstep::run.
  using Runner =
      std::function<std::vector<VariantResult>(const std::vector<const System*>&, const Progress& go_on)>;

  Many(std::size_t count, const VariantBuilder& build, const ManyOptions& options, const Progress& progress)
      : count_(count), build_(build), options_(options), progress_(progress) {}

  /// first: variant 0, built already; block: variants that run together.
  ManyResult run(std::optional<System> first, std::size_t block, const Runner& runner) {
    first_ = std::move(first);
    if (first_) topology_.emplace(*first_);
    result_.variants.resize(count_);
    const std::size_t blocks = (count_ + block - 1) / block;
    parts_ = std::vector<std::atomic<double>>(thread_count(blocks, options_.threads));
    for_all(blocks, options_.threads, [&](std::size_t b, std::size_t thread) {
      if (stop_) return;
      try {
        run_block(thread, b * block, std::min(count_, (b + 1) * block), runner);
      } catch (...) {
        stop_ = true;  // the blocks beside it, too
        throw;
      }
    });
    if (stop_) {
      result_.interrupted = true;
      for (VariantResult& v : result_.variants)
        if (v.error.empty() && v.summary.scheme.empty()) {
          v.summary.status = RunStatus::interrupted;
          v.summary.reason = "interrupted before it began";
        }
    }
    return std::move(result_);
  }

 private:
  void run_block(std::size_t thread, std::size_t begin, std::size_t end, const Runner& runner) {
    std::vector<std::size_t> variants;
    std::vector<System> systems;
    for (std::size_t i = begin; i < end; ++i)
      if (std::optional<System> system = build(i)) {
        variants.push_back(i);
        systems.push_back(std::move(*system));
      }
    // Variants that step together have the same breakpoints and laws.
    const auto alike = [](const System& a, const System& b) {
      return a.breakpoints() == b.breakpoints() &&
             std::equal(a.scalars().begin(), a.scalars().end(), b.scalars().begin(), b.scalars().end(),
                        [](const ScalarTerm& x, const ScalarTerm& y) { return x.element == y.element; });
    };
    std::vector<bool> done(systems.size(), false);
    double run = 0.0;
    for (std::size_t i = 0; i < systems.size(); ++i) {
      if (done[i]) continue;
      std::vector<const System*> together;
      std::vector<std::size_t> indices;
      for (std::size_t j = i; j < systems.size(); ++j)
        if (!done[j] && alike(systems[j], systems[i])) {
          done[j] = true;
          together.push_back(&systems[j]);
          indices.push_back(variants[j]);
        }
      const auto size = static_cast<double>(together.size());
      run_together(together, indices, runner, [&](double part) { return report(thread, run + part * size); });
      run += size;
    }
    parts_[thread] = 0.0;
    finished_ += end - begin;
    report(thread, 0.0);
  }

  void run_together(const std::vector<const System*>& systems, const std::vector<std::size_t>& indices,
                    const Runner& runner, const Progress& go_on) {
    try {
      std::vector<VariantResult> results = runner(systems, go_on);
      for (std::size_t i = 0; i < indices.size(); ++i) {
        if (options_.stop_at_error && !results[i].error.empty()) throw SolverError(results[i].error);
        result_.variants[indices[i]] = std::move(results[i]);
      }
    } catch (const std::exception& e) {
      if (options_.stop_at_error || stop_) throw;
      if (systems.size() == 1) {
        result_.variants[indices[0]].error = e.what();
        return;
      }
      for (std::size_t i = 0; i < indices.size(); ++i)  // which of them it was
        run_together({systems[i]}, {indices[i]}, runner, go_on);
    }
  }

  std::optional<System> build(std::size_t i) {
    if (i == 0 && first_) return std::move(first_);
    try {
      System system = build_(i);
      std::string difference;
      {
        const std::lock_guard lock(mutex_);
        if (!topology_) topology_.emplace(system);
        difference = topology_->difference(system);
      }
      if (difference.empty()) return system;
      throw TopologyError(
          {{system.name(), "variant", std::to_string(i), "", difference + "; all must have one topology"}});
    } catch (const TopologyError&) {
      throw;
    } catch (const std::exception& e) {
      if (options_.stop_at_error) throw;
      result_.variants[i].error = e.what();
      return std::nullopt;
    }
  }

  bool report(std::size_t thread, double part) {
    parts_[thread] = part;
    if (stop_) return false;
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (!progress_ || !lock) return true;
    double done = static_cast<double>(finished_);
    for (const std::atomic<double>& p : parts_) done += p;
    if (!progress_(std::min(1.0, done / static_cast<double>(count_)))) stop_ = true;
    return !stop_;
  }

  struct TopologyError final : ModelError {
    using ModelError::ModelError;
  };

  std::size_t count_;
  const VariantBuilder& build_;
  const ManyOptions& options_;
  const Progress& progress_;
  std::optional<System> first_;
  std::optional<Topology> topology_;
  ManyResult result_;
  std::vector<std::atomic<double>> parts_;  // variants done by each thread, their parts among them
  std::atomic<std::size_t> finished_ = 0;
  std::atomic<bool> stop_ = false;
  std::mutex mutex_;
};

template <class Options>
RunSummary run_one(const System& system, const Options& options, State& state,
                   std::vector<Observer*> observers) {
  StiffTwists stiff(system);
  if (stiff.any()) observers.push_back(&stiff);
  RunSummary summary;
  if constexpr (std::is_same_v<Options, TransientOptions>)
    summary = simulate(system, options, state, observers);
  else
    summary = propagate(system, options, state, observers);
  stiff.warn(summary);
  return summary;
}

/// One variant by itself.
template <class Options>
std::vector<VariantResult> one_by_one(const std::vector<const System*>& systems, Options options,
                                      const std::vector<std::string>& channels,
                                      const std::function<bool(double)>& go_on) {
  constexpr bool exact = std::is_same_v<Options, ExactOptions>;
  std::vector<VariantResult> results;
  for (std::size_t i = 0; i < systems.size(); ++i) {
    const System& system = *systems[i];
    const auto count = static_cast<double>(systems.size());
    options.progress = [&](double part) { return go_on((static_cast<double>(i) + part) / count); };
    Peaks peaks(find_channels(system, channels), exact);
    ContactStatistics contacts(system, exact);
    VariantResult r;
    r.state = State::initial(system, options.t_start);
    r.summary = run_one(system, options, r.state, {&peaks, &contacts});
    r.peaks = peaks.peaks();
    r.contacts = contacts.records();
    results.push_back(std::move(r));
  }
  return results;
}

/// Variant 0, or nothing where its builder threw and that is no reason to stop.
std::optional<System> build_first(const VariantBuilder& build, const ManyOptions& many) {
  try {
    return build(0);
  } catch (const std::exception&) {
    if (many.stop_at_error) throw;
    return std::nullopt;
  }
}

}  // namespace

ManyResult simulate_many(std::size_t count, const VariantBuilder& build, const TransientOptions& options,
                         const ManyOptions& many) {
  if (count == 0) return {};
  Many run(count, build, many, options.progress);
  std::optional<System> first = build_first(build, many);
  std::optional<std::string> why_not;
  if (first) {
    check_options(*first, options, State::initial(*first, options.t_start));
    find_channels(*first, many.channels);
    why_not = why_not_lockstep(*first, options);
  }
  if (!many.lockstep) why_not = "not wanted";
  ManyResult result =
      run.run(std::move(first), why_not ? 1 : kLanes,
              [&](const std::vector<const System*>& systems, const std::function<bool(double)>& go_on) {
                if (why_not || why_not_lockstep(*systems.front(), options))
                  return one_by_one(systems, options, many.channels, go_on);
                return Lockstep(systems, options, many.channels).run(go_on);
              });
  result.why_not_lockstep = why_not.value_or("");
  return result;
}

ManyResult propagate_many(std::size_t count, const VariantBuilder& build, const ExactOptions& options,
                          const ManyOptions& many) {
  if (count == 0) return {};
  Many run(count, build, many, options.progress);
  std::optional<System> first = build_first(build, many);
  if (first) find_channels(*first, many.channels);
  ManyResult result =
      run.run(std::move(first), 1,
              [&](const std::vector<const System*>& systems, const std::function<bool(double)>& go_on) {
                return one_by_one(systems, options, many.channels, go_on);
              });
  result.why_not_lockstep = "exact propagation takes the steps of each variant's own modes and contacts";
  return result;
}

}  // namespace drev
