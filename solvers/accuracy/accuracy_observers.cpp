#include "solvers/accuracy/accuracy_observers.hpp"

#include <algorithm>
#include <cmath>

namespace drev {

namespace {

constexpr double kSameTime = 1e-9;  // relative to a batch
constexpr double kSettled = 0.1;    // of the whole run: left out of time averages

std::vector<Channel> none_or_one(const System& system, const std::string& name) {
  return name.empty() ? std::vector<Channel>{} : find_channels(system, {name});
}

}  // namespace

double Watched::left_out(const AccuracyOptions& o) { return o.from > 0.0 ? 0.0 : kSettled; }

Watched::Watched(const System& system, const AccuracyOptions& o, const std::string& followed, double every)
    : deflection(none_or_one(system, o.deflection)),
      torque(find_channels(system, o.torques)),
      mesh(find_channels(system, o.meshes)),
      edges(system),
      batches(system, find_channels(system, {followed}), o.from + left_out(o) * (o.t_end - o.from), o.t_end,
              kBatches),
      contacts(system),
      recorder(system, {followed}, every),
      span_(o.from, {&deflection, &torque, &mesh, &edges, &batches, &contacts, &recorder}) {}

/// Integrals of the cubic and, by the same rule, of its square.
void BatchWatch::Sum::Pair::add(double y_0, double r_0, double y_1, double r_1, double h) {
  value += 0.5 * h * (y_0 + y_1) + h * h / 12.0 * (r_0 - r_1);
  square += 0.5 * h * (y_0 * y_0 + y_1 * y_1) + h * h / 6.0 * (y_0 * r_0 - y_1 * r_1);
}

void BatchWatch::Sum::add(double y_0, double r_0, double y_1, double r_1, double h) {
  fine_.add(y_0, r_0, y_1, r_1, h);
  if (h_ == 0.0) {
    y_ = y_0, r_ = r_0, h_ = h;
    open_.add(y_0, r_0, y_1, r_1, h);
    return;
  }
  coarse_.add(y_, r_, y_1, r_1, h_ + h);
  open_ = {};
  h_ = 0.0;
}

void BatchWatch::Sum::close(double length, Integrals& mean, Integrals& rms) {
  // Twice the interval makes a kink's error at least three times as large, a smooth function's 15 times.
  const auto off = [](double fine, double coarse, double open) {
    return std::abs(coarse + open - fine) / 3.0;
  };
  const double square = std::max(0.0, fine_.square / length), root = std::sqrt(square);
  mean.add(fine_.value / length, off(fine_.value, coarse_.value, open_.value) / length);
  const double of_square = off(fine_.square, coarse_.square, open_.square) / length;
  rms.add(root, root > 0.0 ? 0.5 * of_square / root : std::sqrt(of_square));
  *this = {};
}

Estimate BatchWatch::Integrals::estimate(int batches) const {
  Estimate e = batch_mean(values, batches);
  for (const double error : errors) e.error += error / static_cast<double>(errors.size());
  return e;
}

BatchWatch::BatchWatch(const System& system, std::vector<Channel> channels, double begin, double end,
                       int batches)
    : channels_(std::move(channels)),
      begin_(begin),
      length_((end - begin) / batches),
      batches_(batches),
      statistics_(system, false),
      values_(channels_.size()) {
  for (std::size_t j = 0; j < system.scalars().size(); ++j)
    if (system.scalars()[j].force->gap()) laws_.push_back(j);
  forces_.resize(laws_.size());
  for (const ContactRecord& r : statistics_.records()) {
    const auto same = [&](const Channel& c) { return c.name() == r.element + ".force_N"; };
    const std::vector<Channel> all = all_channels(system);
    contacts_.push_back(
        {.element = r.element, .unit = std::any_of(all.begin(), all.end(), same) ? "N" : "N m"});
  }
  for (const Channel& c : channels_) averages_.push_back({.channel = c.name(), .unit = c.unit()});
}

void BatchWatch::start(const Assembler& assembler, const EvaluatedState& point) {
  statistics_.start(assembler, point);
  begin_batch();
  done_ = point.state.t < begin_ - kSameTime * length_ ? 0 : 1;
}

double BatchWatch::next_stop(double /*t*/) const { return begin_ + done_ * length_; }

void BatchWatch::step(const Assembler& assembler, const EvaluatedState& from, const EvaluatedState& to) {
  statistics_.step(assembler, from, to);
  const double h = to.state.t - from.state.t, same = kSameTime * length_;
  if (from.state.t < begin_ - same) {  // ahead of the first batch
    begin_batch();
    if (to.state.t >= begin_ - same) done_ = 1;
    return;
  }
  for (std::size_t i = 0; i < laws_.size(); ++i) {
    const std::size_t j = laws_[i];
    const ScalarResponse &a = from.responses[j], &b = to.responses[j];
    forces_[i].add(a.y, a.dy_dx * from.inputs[j].x_dot, b.y, b.dy_dx * to.inputs[j].x_dot, h);
  }
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    const auto r_0 = channels_[c].rate(assembler, from.state), r_1 = channels_[c].rate(assembler, to.state);
    values_[c].add(channels_[c].evaluate(assembler, from.state), r_0.value_or(0.0),
                   channels_[c].evaluate(assembler, to.state), r_1.value_or(0.0), h);
  }
  if (done_ <= batches_ && to.state.t >= next_stop(0.0) - same) close();
}

void BatchWatch::begin_batch() {
  before_.clear();
  for (const ContactRecord& r : statistics_.records())
    before_.push_back({r.time_separated, r.impact_energy, r.impacts()});
}

void BatchWatch::close() {
  ++done_;
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    const Begin& a = before_[i];
    const ContactRecord& b = statistics_.records()[i];
    contacts_[i].share_separated.push_back((b.time_separated - a.time_separated) / length_);
    contacts_[i].impacts_per_second.push_back(static_cast<double>(b.impacts() - a.impacts) / length_);
    contacts_[i].impact_power.push_back((b.impact_energy - a.impact_energy) / length_);
    forces_[i].close(length_, contacts_[i].mean_force, contacts_[i].rms_force);
  }
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    values_[c].close(length_, averages_[c].mean, averages_[c].rms);
  }
  begin_batch();
}

}  // namespace drev
