#include "tests/stability/coverage/reference_figures.hpp"

#include <algorithm>
#include <stdexcept>

namespace coverage {

namespace {

/// Largest and least values, on the polynomials of every step.
class PeakFinder {
 public:
  explicit PeakFinder(std::vector<ReferencePeak>& peaks) : peaks_(peaks) {}
  void operator()(const ReferenceStep& step) {
    const std::vector<ChannelId>& channels = step.model.channels();
    const bool first = peaks_.empty();
    peaks_.resize(channels.size());
    for (std::size_t c = 0; c < channels.size(); ++c) {
      ReferencePeak& p = peaks_[c];
      const Poly y = step.model.channel(channels[c]);
      if (first) p = {y.a[0], step.t, y.a[0], step.t};
      if (upper_bound(y, step.h) <= p.most && lower_bound(y, step.h) >= p.least) continue;
      for (const Real s : extremes(y, step.h)) {
        const Real value = y.value(s);
        if (value > p.most) p.most = value, p.most_time = step.t + s;
        if (value < p.least) p.least = value, p.least_time = step.t + s;
      }
    }
  }

 private:
  std::vector<ReferencePeak>& peaks_;
};

class Sampler {
 public:
  Sampler(const std::vector<double>& times, std::vector<std::vector<Real>>& samples)
      : times_(times), samples_(samples) {}
  void operator()(const ReferenceStep& step) {
    const std::vector<ChannelId>& channels = step.model.channels();
    samples_.resize(channels.size());
    std::size_t last = next_;
    while (last < times_.size() && times_[last] <= step.t + step.h) ++last;
    if (last == next_) return;
    for (std::size_t c = 0; c < channels.size(); ++c) {
      const Poly y = step.model.channel(channels[c]);
      for (std::size_t i = next_; i < last; ++i) samples_[c].push_back(y.value(times_[i] - step.t));
    }
    next_ = last;
  }

 private:
  const std::vector<double>& times_;
  std::vector<std::vector<Real>>& samples_;
  std::size_t next_ = 0;
};

class EdgeFinder {
 public:
  explicit EdgeFinder(std::vector<EdgeTime>& edges) : edges_(edges) {}
  void operator()(const ReferenceStep& step) {
    if (!step.passes) return;
    const Guard& g = *step.passes;
    if (g.of == Guard::Of::mesh_edge) {
      edges_.push_back(
          {step.t + step.h, "mesh" + std::to_string(g.index), step.model.mesh_side(g.index) == 0, g.side});
    } else if (g.of == Guard::Of::polyline) {
      const ReferenceModel::Gap gap = step.model.polyline_gap(g.index);
      const Polyline& p = step.model.spec().polylines[static_cast<std::size_t>(g.index)];
      const int knot = step.model.segment(g.index) + (g.side > 0 ? 1 : 0);
      const Real x = p.x[static_cast<std::size_t>(knot)];
      if (gap.low >= gap.high || (x != gap.low && x != gap.high)) return;
      const int flank = x == gap.high ? 1 : -1;
      edges_.push_back({step.t + step.h, "polyline" + std::to_string(g.index), g.side == flank, flank});
    }
  }

 private:
  std::vector<EdgeTime>& edges_;
};

}  // namespace

namespace {

ReferenceResult run(ReferenceModel& model, const ReferencePrecision& precision,
                    const std::vector<double>& sample_times) {
  ReferenceResult r;
  PeakFinder peaks(r.peaks);
  Sampler sampler(sample_times, r.samples);
  EdgeFinder edges(r.edges);
  try {
    run_reference(model, model.spec().duration, precision,
                  {peaks, sampler, edges, [&](const ReferenceStep&) { ++r.steps; }});
  } catch (const std::runtime_error& e) {
    r.failed = true;
    r.reason = e.what();
  }
  return r;
}

}  // namespace

ReferenceResult reference_result(const Spec& spec, const ReferencePrecision& precision,
                                 const std::vector<double>& sample_times) {
  ReferenceModel model(spec);
  return run(model, precision, sample_times);
}

ReferenceResult reference_result_beside(const ReferenceResult& other, double moved, const Spec& spec,
                                        const ReferencePrecision& precision,
                                        const std::vector<double>& sample_times) {
  Spec beside = spec;
  const std::vector<ChannelId> channels = ReferenceModel(spec).channels();
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const double change = moved * static_cast<double>(other.peaks[c].amplitude()) * (c % 2 ? 1.0 : -1.0);
    Node& node = beside.nodes[static_cast<std::size_t>(channels[c].index)];
    if (channels[c].kind == ChannelId::Kind::angle) node.angle += change;
    if (channels[c].kind == ChannelId::Kind::speed) node.speed += change;
  }
  ReferenceModel model(beside);
  return run(model, precision, sample_times);
}

}  // namespace coverage
