#include "solvers/periodic/linear_response.hpp"

#include <drev/core/channel.hpp>
#include <drev/core/error.hpp>
#include <drev/core/law/frequency_stiffness.hpp>
#include <drev/core/law/friction.hpp>
#include <drev/core/units.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "solvers/periodic/bracketed_search.hpp"

namespace drev {

namespace {

using Complex = std::complex<double>;
using Section = LinearResponse::Section;

constexpr double kNoDrag = 1e-13;  // drag relative to speed times largest damping that is rounding [-]

template <class Values>
auto product(const std::vector<Entry>& row, const Values& z) {
  auto sum = z[0] * 0.0;
  for (const Entry& e : row) sum += e.coeff * z[static_cast<std::size_t>(e.index)];
  return sum;
}

std::string element_name(const System& system, ElementId id) {
  return system.element_instances()[idx(index(id))].name;
}

}  // namespace

LinearResponse::LinearResponse(const System& system, const LinearSweepOptions& options,
                               const std::vector<double>& orders, std::vector<Finding>& findings)
    : system_(system), assembler_(system), orders_(orders) {
  check_model(options.close_contacts, findings);
  content_.emplace(system, orders, findings);
  std::map<int, std::vector<std::size_t>> on_unknown;
  for (const LoadTerm* load : content_->loads()) {
    const std::vector<Entry>& row = load_rows_.emplace_back(system.row_of(load->node));
    if (row.size() == 1) on_unknown[row[0].index].push_back(load_rows_.size() - 1);
  }
  for (const auto& [unknown, loads] : on_unknown)
    if (loads.size() > 1) together_.push_back(loads);
  assembler_.contact_values({1.0, 0.0, 0.0}, Contact::closed, mass_);
  assembler_.contact_values({0.0, 1.0, 0.0}, Contact::closed, damping_);
  assembler_.contact_values({0.0, 0.0, 1.0}, Contact::closed, stiffness_);
  sections_ = find_section_rows(system, options.sections, findings);
  direction_ = reference_direction(system_);
  complex_.emplace(system, looked_at());
  const std::vector<bool>& held = complex_->held();
  Vector static_stiffness = stiffness_, no_loss = damping_;
  complex_->add(
      1.0,
      [&](std::size_t t) -> Complex {
        return system.frequency_terms()[t].stiffness->static_beyond_matrices();
      },
      no_loss, static_stiffness);
  if (findings.empty()) mean_.emplace(system_, damping_, static_stiffness, options.balance, findings);
  elimination_.emplace(system.pattern(), held);
  lanes_.emplace(*elimination_);
  rows_.emplace(system_, load_rows_, sections_, held);
  z_.resize(idx(system.size()));
  carried_.resize(complex_->count());
  for (LaneArray* rows : {&beyond_re_, &beyond_im_}) rows->resize(complex_->count() * kLaneSets);
  for (const FrequencyTerm& term : system.frequency_terms()) {
    follows_mean_ |= term.stiffness->follows_mean_torque();
    follows_amplitude_ |= !term.stiffness->amplitudes().empty();
  }
  all_constant_ = !follows_mean_ && !follows_amplitude_;
  for (std::size_t t = 0; t < complex_->count(); ++t) all_constant_ &= complex_->constant(t);
  for (LaneArray* rows : {&re_, &im_, &p_re_, &p_im_}) rows->resize(idx(system.size()) * kLaneSets);
  given_.resize(load_rows_.size() * LaneSections::kFrequencies);
}

void LinearResponse::check_model(bool close_contacts, std::vector<Finding>& findings) const {
  const auto refuse = [&](const std::string& place, const std::string& why) {
    findings.push_back({system_.name() + (place.empty() ? "" : "/" + place), "", "", "", why});
  };
  if (system_.size() == 0) refuse("", "every node is prescribed: nothing vibrates");
  if (!system_.reference())
    refuse("", "no shaft turns nominally: orders need a reference shaft (nominal_speed or constant_speed)");
  if (const auto why = system_.why_not_varying_inertia("a sweep")) refuse("", *why);
  for (const ScalarTerm& term : system_.scalars()) {
    const std::string name = element_name(system_, term.element);
    if (!close_contacts)
      refuse(name,
             "is not linear; close_contacts (--contact closed) takes its stiffness with the "
             "contact closed, at its mean over the mesh");
    if (term.phase_node < 0) continue;
    for (int i = 0; i < 16; ++i)
      if (const Offset offset = term.force->offset(0.7 * i); offset.e != 0.0 || offset.de_dangle != 0.0) {
        refuse(name,
               "has a transmission error, which a linear sweep does not take; harmonic balance "
               "(solve_periodic, drev sweep without --contact closed) does");
        break;
      }
  }
  if (const auto why = why_not_friction(system_, "a sweep")) refuse("", *why);
  for (const GeneralTerm& term : system_.generals())
    refuse(element_name(system_, term.element),
           "is a general element, which a linear sweep does not take; "
           "harmonic balance (solve_periodic) does");
  if (system_.any_prescribed_moves())
    for (int k = 0; k < system_.prescribed_count(); ++k)
      if (system_.prescribed()[idx(k)].at)
        refuse(system_.node_names()[idx(system_.prescribed_node(k))],
               "has a given motion in time, which has no orders");
}

void LinearResponse::add_frequency_terms(double omega) {
  damping_at_omega_ = damping_here_;
  stiffness_at_omega_ = stiffness_here_;
  complex_->add(
      omega, [&](std::size_t t) { return beyond(t, omega); }, damping_at_omega_, stiffness_at_omega_);
}

void LinearResponse::spread_frequency_terms(int sets) {
  if (all_constant_ && spread_) return;
  const auto used = all_constant_ ? kLaneSets : sets;
  for (std::size_t t = 0; t < carried_.size(); ++t)
    for (int lane = 0; lane < used * kLanes; ++lane) {
      const auto row = t * kLaneSets + idx(lane / kLanes);
      const double w = w_[all_constant_ ? 0 : idx(lane / kLanes)].v[all_constant_ ? 0 : lane % kLanes];
      const Complex k = beyond(t, std::abs(w));
      beyond_re_[row].v[lane % kLanes] = k.real();
      // At a negative w, k* is the complex conjugate.
      beyond_im_[row].v[lane % kLanes] = w < 0.0 ? -k.imag() : k.imag();
    }
  if (!all_constant_) {
    for (LaneArray* values : {&stiffness_lanes_, &loss_lanes_})
      values->resize(static_cast<std::size_t>(stiffness_here_.size()) * kLaneSets);
    spread_at_slots(sets, complex_->slots(), complex_->slot_terms(), complex_->slot_times(), beyond_re_,
                    beyond_im_, stiffness_here_, stiffness_lanes_, loss_lanes_);
    return;
  }
  stiffness_common_ = stiffness_here_;
  loss_common_.setZero(stiffness_here_.size());
  complex_->add(
      1.0,
      [&](std::size_t t) -> Complex {
        return {beyond_re_[t * kLaneSets].v[0], beyond_im_[t * kLaneSets].v[0]};
      },
      loss_common_, stiffness_common_);
  spread_ = true;
}

Complex LinearResponse::beyond(std::size_t term, double omega) const {
  return complex_->beyond(term, omega, carried_[term]);
}

std::vector<bool> LinearResponse::looked_at() const {
  std::vector<bool> used(idx(system_.size()), false);
  const auto use = [&](const std::vector<Entry>& row) {
    for (const Entry& e : row) used[idx(e.index)] = true;
  };
  for (const Section& s : sections_)
    if (s.frequency_term < 0) use(s.stiffness), use(s.damping), use(s.twist);
  return used;
}

const Vector& LinearResponse::damping_at(double speed) {
  const auto& contents = content_->at(direction_ * speed);
  const bool plain = std::all_of(contents.begin(), contents.end(), [](const OrderContent::Content& c) {
    return c.speed_slope == 0.0 && c.angle_slope == 0.0;
  });
  if (plain && plain_) return damping_here_;
  plain_ = plain;
  std::swap(damping_here_, damping_before_);
  std::swap(stiffness_here_, stiffness_before_);
  damping_here_ = damping_;
  stiffness_here_ = stiffness_;
  content_->add_slopes(direction_ * speed, &damping_here_, &stiffness_here_);
  // Most loads that depend on the speed have no slope of their own.
  spread_ = spread_ && damping_here_ == damping_before_ && stiffness_here_ == stiffness_before_;
  return damping_here_;
}

std::vector<double> LinearResponse::load_means(double speed) {
  std::vector<double> means;
  for (const OrderContent::Content& load : content_->at(direction_ * speed)) means.push_back(load.mean);
  return means;
}

std::vector<double> LinearResponse::mean_motion(double speed, const std::vector<double>& means,
                                                Vector& unbalanced, Vector& load_sum) {
  Vector p = -direction_ * speed * system_.nominal_drag().head(system_.size());
  // Rounding of the ratios leaves a drag of dampers between nodes of equal speed.
  if (p.cwiseAbs().maxCoeff() <= kNoDrag * speed * damping_.cwiseAbs().maxCoeff()) p.setZero();
  const std::vector<Vector>& rigid = mean_->rigid();
  load_sum = Vector::Zero(static_cast<Eigen::Index>(rigid.size()));
  for (std::size_t f = 0; f < rigid.size(); ++f)
    load_sum[static_cast<Eigen::Index>(f)] += rigid[f].cwiseProduct(p).cwiseAbs().sum();
  for (std::size_t l = 0; l < means.size(); ++l) {
    for (const Entry& e : load_rows_[l]) p[e.index] += e.coeff * means[l];
    for (std::size_t f = 0; f < rigid.size(); ++f)
      load_sum[static_cast<Eigen::Index>(f)] += std::abs(product(load_rows_[l], rigid[f]) * means[l]);
  }
  mean_->solve(p, &unbalanced);
  return {p.begin(), p.end()};
}

void LinearResponse::mean(double speed, Point& point) {
  const auto& contents = content_->at(direction_ * speed);
  const auto count = static_cast<Eigen::Index>(sections_.size()),
             loads = static_cast<Eigen::Index>(contents.size());
  // All means are linear in the speed and in the means of the loads.
  constexpr Eigen::Index kFewLoads = 64;
  if (loads <= kFewLoads) {
    if (mean_of_parts_.size() == 0) find_mean_of_parts(loads);
    given_means_.resize(loads + 1);
    for (Eigen::Index l = 0; l < loads; ++l) given_means_[l] = contents[static_cast<std::size_t>(l)].mean;
    given_means_[loads] = speed;
    mean_figures_.noalias() = mean_of_parts_ * given_means_;
    point.mean = mean_figures_.head(count), point.twist_mean = mean_figures_.segment(count, count);
    point.unbalanced = mean_figures_.tail(mean_figures_.size() - 2 * count);
    point.load_sum.noalias() = sum_of_parts_ * given_means_.cwiseAbs();
    return;
  }
  find_means(mean_motion(speed, load_means(speed), point.unbalanced, point.load_sum), point);
}

void LinearResponse::find_means(const std::vector<double>& z, Point& point) const {
  const auto count = static_cast<Eigen::Index>(sections_.size());
  point.mean.resize(count), point.twist_mean.resize(count);
  for (Eigen::Index s = 0; s < count; ++s) {
    const Section& section = sections_[static_cast<std::size_t>(s)];
    point.mean[s] = product(section.stiffness, z);
    if (section.frequency_term >= 0) {
      const FrequencyTerm& term = system_.frequency_terms()[idx(section.frequency_term)];
      point.mean[s] += term.stiffness->static_beyond_matrices() * product(term.z, z);
    }
    point.twist_mean[s] = product(section.twist, z);
  }
}

void LinearResponse::find_mean_of_parts(Eigen::Index loads) {
  Point part;
  const auto count = static_cast<Eigen::Index>(sections_.size());
  for (Eigen::Index l = 0; l <= loads; ++l) {
    std::vector<double> means(static_cast<std::size_t>(loads), 0.0);
    if (l < loads) means[static_cast<std::size_t>(l)] = 1.0;
    find_means(mean_motion(l < loads ? 0.0 : 1.0, means, part.unbalanced, part.load_sum), part);
    if (l == 0) {
      mean_of_parts_.resize(2 * count + part.unbalanced.size(), loads + 1);
      sum_of_parts_.resize(part.load_sum.size(), loads + 1);
    }
    mean_of_parts_.col(l) << part.mean, part.twist_mean, part.unbalanced;
    sum_of_parts_.col(l) = part.load_sum;
  }
}

void LinearResponse::find_active(double speed, int only) {
  const auto& contents = content_->at(direction_ * speed);
  active_.clear();
  for (int k = 0; k < static_cast<int>(orders_.size()); ++k) {
    if (only >= 0 && k != only) continue;
    const bool any = std::any_of(contents.begin(), contents.end(), [k](const OrderContent::Content& c) {
      return c.amplitudes[static_cast<std::size_t>(k)] != 0.0;
    });
    if (any) active_.push_back(k);
  }
}

double LinearResponse::amplitude_of(std::size_t t, double speed) {
  twist_squares_.assign(carried_.size(), 0.0);
  for (std::size_t first = 0; first < active_.size(); first += LaneSections::kFrequencies)
    solve_orders(speed, first, trial_);
  return std::sqrt(twist_squares_[t]);
}

void LinearResponse::find_mean_torques(double speed) {
  if (!follows_mean_) return;
  const std::vector<FrequencyTerm>& terms = system_.frequency_terms();
  Vector unbalanced, sums;
  const std::vector<double> z = mean_motion(speed, load_means(speed), unbalanced, sums);
  for (std::size_t t = 0; t < terms.size(); ++t)
    carried_[t].mean_torque =
        (terms[t].stiffness->static_stiffness() + terms[t].stiffness->static_beyond_matrices()) *
        product(terms[t].z, z);
}

Complex LinearResponse::mode_stiffness(std::size_t term, double speed, double omega) {
  const FrequencyStiffness& stiffness = *system_.frequency_terms()[term].stiffness;
  CarriedLoad load = stiffness.load_in_matrices();
  if (stiffness.follows_mean_torque()) {
    find_mean_torques(speed);
    load.mean_torque = carried_[term].mean_torque;
  }
  return complex_->beyond(term, omega, load);
}

ModeMatrices LinearResponse::mode_matrices(double speed, double omega, double part) {
  const Vector& damping = damping_at(speed);
  if (complex_->count() == 0) return {damping, stiffness_, mode_loss_};
  mode_loss_.setZero(damping.size());
  mode_stiffness_ = stiffness_;
  complex_->add(
      1.0,
      [&](std::size_t t) {
        const Complex given =
            complex_->beyond(t, omega, system_.frequency_terms()[t].stiffness->load_in_matrices());
        return given + part * (mode_stiffness(t, speed, omega) - given);
      },
      mode_loss_, mode_stiffness_);
  return {damping, mode_stiffness_, mode_loss_};
}

void LinearResponse::find_carried_loads(double speed) {
  constexpr double kClose = 1e-12;  // relative tolerance of amplitudes [-]
  constexpr int kMostRounds = 100, kMostSteps = 200;
  constexpr int kParts = 16;  // of the distance of two amplitudes of a table, each with one solution at most
  const std::vector<FrequencyTerm>& terms = system_.frequency_terms();
  find_mean_torques(speed);
  several_amplitudes_ = false;
  if (!follows_amplitude_) return;
  const auto orders = static_cast<Eigen::Index>(orders_.size()),
             count = static_cast<Eigen::Index>(sections_.size());
  trial_.amplitude.setZero(orders, count);
  trial_.twist.setZero(orders, count);
  trial_.heat.setZero(count);
  find_active(speed, -1);
  for (CarriedLoad& load : carried_) load.amplitude = 0.0;
  const auto refuse = [&](std::size_t t) {
    throw SolverError(system_.name() + ", " + to_text(to_rpm(speed)) + " rpm: no amplitude of " +
                      element_name(system_, terms[t].element) +
                      " was found that its response under it has; is anything damped there?");
  };
  bool several = false;
  for (int round = 0; round < kMostRounds; ++round) {
    bool moved = false;
    std::size_t number = 0;
    for (std::size_t t = 0; t < terms.size(); ++t) {
      const std::vector<double> table = terms[t].stiffness->amplitudes();
      if (table.empty()) continue;
      several = number++ > 0;
      const double before = carried_[t].amplitude;
      const auto beyond = [&](double a) {  // amplitude of the response minus the assumed amplitude
        carried_[t].amplitude = a;
        return amplitude_of(t, speed) - a;
      };
      std::vector<double> places{0.0};
      for (const double last : table)
        for (int part = 1; part <= kParts && last > places.back(); ++part)
          places.push_back(part < kParts ? places.back() + (last - places.back()) / (kParts - part + 1)
                                         : last);
      IllinoisBracket b{.high = places.back(), .f_high = beyond(places.back())};
      // Beyond the table the response is constant.
      double found = b.f_high > 0.0 ? b.high + b.f_high : 0.0;
      int solutions = b.f_high > 0.0 ? 1 : 0;
      for (std::size_t i = places.size() - 1; i-- > 0; b.high = b.low, b.f_high = b.f_low) {
        b.low = places[i], b.f_low = beyond(b.low);
        if (!std::isfinite(b.f_low) || !std::isfinite(b.f_high)) refuse(t);
        if ((b.f_low > 0.0) == (b.f_high > 0.0) || solutions++ > 0) continue;
        IllinoisBracket root = b;
        found = root.high;
        for (int steps = 0; root.f_high != 0.0 && root.high - root.low > kClose * root.high;) {
          if (++steps > kMostSteps) refuse(t);
          found = root.next();
          const double at = beyond(found);
          if (std::abs(at) <= 1e-3 * kClose * found) break;
          root.take(found, at);
        }
      }
      several_amplitudes_ |= solutions > 1;
      carried_[t].amplitude = found;
      moved |= std::abs(found - before) > 10.0 * kClose * found;
    }
    if (!moved || (round == 0 && !several)) return;
  }
  throw SolverError(system_.name() + ", " + to_text(to_rpm(speed)) +
                    " rpm: the amplitudes of several elements that follow them did not settle");
}

void LinearResponse::solve(double speed, Point& point, int only) {
  lost_orders_.clear();
  content_->at(direction_ * speed);
  if (damping_here_.size() == 0 || content_->follows_speed()) damping_at(speed);
  if (follows_mean_ || follows_amplitude_) find_carried_loads(speed);
  const auto orders = static_cast<Eigen::Index>(orders_.size()),
             count = static_cast<Eigen::Index>(sections_.size());
  find_active(speed, only);
  for (Eigen::MatrixXcd* values : {&point.amplitude, &point.twist}) {
    values->resize(orders, count);
    if (active_.size() < orders_.size()) values->setZero();
  }
  point.heat.setZero(count);
  point.input_power = point.dissipated_power = 0.0;
  for (std::size_t first = 0; first < active_.size(); first += LaneSections::kFrequencies)
    solve_orders(speed, first, point);
}

}  // namespace drev
