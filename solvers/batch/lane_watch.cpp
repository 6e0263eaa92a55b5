#include "solvers/batch/lane_watch.hpp"

#include <cmath>

namespace drev {

LaneWatch::LaneWatch(const std::array<const System*, kLanes>& systems, const std::vector<std::string>& names)
    : watched_(names.size()), systems_(systems) {
  for (int lane = 0; lane < kLanes; ++lane) {
    const std::vector<Channel> found = find_channels(*systems[idx(lane)], names);
    for (std::size_t i = 0; i < names.size(); ++i) watched_[i].channels[idx(lane)] = found[i];
  }
  // A step takes a mesh's phase where it is predicted; a channel's value is of the phase at its end.
  const auto phased = [&](int law) { return systems[0]->scalars()[idx(law)].phase_node >= 0; };
  for (Watched& w : watched_) {
    const Channel& first = w.channels[0];
    const auto rows_of = [&](auto row, std::vector<int>& unknowns, LaneArray& coefficients) {
      for (const Entry& e : row(first)) unknowns.push_back(e.index);
      coefficients.resize(unknowns.size());
      for (int lane = 0; lane < kLanes; ++lane)
        for (std::size_t e = 0; e < unknowns.size(); ++e)
          coefficients[e].v[lane] = row(w.channels[idx(lane)])[e].coeff;
    };
    if (first.is_linear()) {
      w.kind = Watched::Kind::linear;
      rows_of([](const Channel& c) -> const std::vector<Entry>& { return c.z_row(); }, w.z, w.z_coeff);
      rows_of([](const Channel& c) -> const std::vector<Entry>& { return c.v_row(); }, w.v, w.v_coeff);
    } else if (const int law = first.force_of(); law >= 0 && !phased(law)) {
      w.kind = Watched::Kind::force;
      w.law = law;
    } else if (first.deflection_of() >= 0) {
      w.kind = Watched::Kind::deflection;
      w.law = first.deflection_of();
    }
  }
  std::array<std::vector<double>, kLanes> masses;
  for (int lane = 0; lane < kLanes; ++lane) masses[idx(lane)] = equivalent_masses(*systems[idx(lane)]);
  for (std::size_t j = 0; j < systems[0]->scalars().size(); ++j) {
    if (!systems[0]->scalars()[j].force->gap()) continue;
    Contact c;
    c.law = static_cast<int>(j);
    for (int lane = 0; lane < kLanes; ++lane) {
      const Gap gap = beyond_rounding(systems[idx(lane)]->scalars()[j].force->gap().value_or(Gap{}));
      c.low.v[lane] = gap.low;
      c.high.v[lane] = gap.high;
      c.masses[idx(lane)] = masses[idx(lane)][j];
    }
    contacts_.push_back(c);
  }
}

struct LaneWatchKernels {
  DREV_WIDEST static void sum(const LaneWatch::Watched& c, const LanePoint& point, LaneRow& out) {
    Lanes sum{};
    for (std::size_t e = 0; e < c.z.size(); ++e)
      sum += c.z_coeff[e].v * point.z[static_cast<std::size_t>(c.z[e])].v;
    for (std::size_t e = 0; e < c.v.size(); ++e)
      sum += c.v_coeff[e].v * point.v[static_cast<std::size_t>(c.v[e])].v;
    out.v = sum;
  }

  DREV_WIDEST static void peak(LaneWatch::Watched& c, const LaneRow& value, double t, const LaneMask& lanes) {
    c.peak.note(value.v, t, lanes);
  }

  /// True: a lane passes an edge, its impacts are to be seen to.
  DREV_WIDEST static bool contact(LaneWatch::Contact& c, const LanePointLaws& from, const LanePointLaws& to,
                                  double h, double t, const LaneMask& lanes) {
    const auto j = static_cast<std::size_t>(c.law);
    Lanes size = to.y[j].v;
    magnitude(size);
    note_force(c.totals, size, t, lanes, c.largest);
    return note_time_separated(c.totals, c.low.v, c.high.v, from.x[j].v, to.x[j].v, h, lanes);
  }
};

void LaneWatch::value(const Watched& c, const std::vector<Assembler>& assemblers, const LanePoint& point,
                      double t, LaneRow& out) const {
  switch (c.kind) {
    case Watched::Kind::linear:
      return LaneWatchKernels::sum(c, point, out);
    case Watched::Kind::force:
      out = point.laws.y[idx(c.law)];
      return;
    case Watched::Kind::deflection:
      out = point.laws.x[idx(c.law)];
      return;
    case Watched::Kind::other:
      break;
  }
  EvaluatedState of_lane;
  for (int lane = 0; lane < kLanes; ++lane) {
    point.get(lane, of_lane);
    of_lane.state.t = t;
    out.v[lane] = c.channels[idx(lane)].evaluate(assemblers[idx(lane)], of_lane.state);
  }
}

void LaneWatch::start(const std::vector<Assembler>& assemblers, const LanePoint& point, double t) {
  for (Watched& c : watched_) {
    value(c, assemblers, point, t, c.peak.max);
    c.peak.min = c.peak.max;
    c.peak.max_time.v = c.peak.min_time.v = Lanes{} + t;
  }
  for (Contact& c : contacts_)
    for (int lane = 0; lane < kLanes; ++lane) {
      c.totals.largest_force.v[lane] = std::abs(point.laws.y[idx(c.law)].v[lane]);
      c.totals.largest_force_time.v[lane] = t;
    }
}

void LaneWatch::step(const std::vector<Assembler>& assemblers, const LanePoint& from, const LanePoint& to,
                     double h, double t, const LaneMask& lanes) {
  LaneRow now;
  for (Watched& c : watched_) {
    value(c, assemblers, to, t, now);
    LaneWatchKernels::peak(c, now, t, lanes);
  }
  for (Contact& c : contacts_)
    if (LaneWatchKernels::contact(c, from.laws, to.laws, h, t, lanes)) cross(c, from.laws, to.laws, lanes);
}

void LaneWatch::cross(Contact& c, const LanePointLaws& from, const LanePointLaws& to, const LaneMask& lanes) {
  const std::size_t j = idx(c.law);
  for (int lane = 0; lane < kLanes; ++lane) {
    if (lanes[lane] == 0) continue;
    ContactInterval interval{c.met[idx(lane)], c.largest.v[lane]};
    note_crossings({c.low.v[lane], c.high.v[lane]}, {.x = from.x[j].v[lane], .x_dot = from.x_dot[j].v[lane]},
                   {.x = to.x[j].v[lane], .x_dot = to.x_dot[j].v[lane]}, std::abs(to.y[j].v[lane]),
                   c.masses[idx(lane)], interval, c.records[idx(lane)]);
    c.met[idx(lane)] = interval.met;
    c.largest.v[lane] = interval.largest;
  }
}

std::vector<Peak> LaneWatch::peaks(int lane) const {
  std::vector<Peak> all;
  for (const Watched& c : watched_) {
    const Extremes<LaneRow>& p = c.peak;
    all.push_back({{p.max.v[lane], p.max_time.v[lane], p.min.v[lane], p.min_time.v[lane]}});
  }
  return all;
}

std::vector<ContactRecord> LaneWatch::contacts(int lane) const {
  std::vector<ContactRecord> all;
  for (const Contact& c : contacts_) {
    const System& system = *systems_[idx(lane)];
    ContactRecord r = c.records[idx(lane)];
    r.element = system.element_instances()[idx(index(system.scalars()[idx(c.law)].element))].name;
    r.time_separated = c.totals.time_separated.v[lane];
    r.largest_force = c.totals.largest_force.v[lane];
    r.largest_force_time = c.totals.largest_force_time.v[lane];
    all.push_back(std::move(r));
  }
  return all;
}

}  // namespace drev
