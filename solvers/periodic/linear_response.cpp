#include "solvers/periodic/linear_response.hpp"

#include <drev/core/channel.hpp>
#include <drev/core/error.hpp>
#include <drev/core/law/frequency_stiffness.hpp>
#include <drev/core/units.hpp>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace drev {

namespace {

using Complex = std::complex<double>;
using Section = LinearResponse::Section;

constexpr double kNoDrag = 1e-13;  // of the largest damping

std::vector<Entry> over_unknowns(const System& system, const std::vector<Entry>& nodes, double factor = 1.0) {
  std::vector<Entry> row;
  for (const Entry& node : nodes)
    for (const Entry& e : system.row_of(node.index)) row.push_back({e.index, factor * node.coeff * e.coeff});
  return row;
}

template <class Values>
auto product(const std::vector<Entry>& row, const Values& z) {
  auto sum = z[0] * 0.0;
  for (const Entry& e : row) sum += e.coeff * z[static_cast<std::size_t>(e.index)];
  return sum;
}

double largest_coefficient(const std::vector<Entry>& row) {
  double largest = 0.0;
  for (const Entry& e : row) largest = std::max(largest, std::abs(e.coeff));
  return largest;
}

std::string element_name(const System& system, ElementId id) {
  return system.element_instances()[idx(index(id))].name;
}

/// Sections of the elements whose terms stand in the matrices, by channel.
std::map<std::string, Section> element_sections(const System& system, std::vector<std::string>& in_order) {
  std::map<std::string, Section> sections;
  const std::vector<OutputTerm> outputs = system.outputs();
  for (std::size_t o = 0; o < outputs.size(); ++o) {
    const OutputTerm& term = outputs[o];
    if (term.deflection) continue;
    const std::vector<Entry>& given = term.stiffness.empty() ? term.damping : term.stiffness;
    const bool turns = std::all_of(given.begin(), given.end(), [&](const Entry& e) {
      return system.node_kind(e.index) == NodeKind::rotational;
    });
    const bool torque = turns && !term.along_line_of_action;
    Section section;
    section.unit = torque ? "N m" : "N";
    section.name = element_name(system, term.element) + (term.suffix.empty() ? "" : "_" + term.suffix) +
                   (torque ? ".torque_Nm" : ".force_N");
    section.stiffness = over_unknowns(system, term.stiffness);
    section.damping = section.damper = over_unknowns(system, term.damping);
    section.twist_unit = torque ? "rad" : "m";
    const bool stated =
        o + 1 < outputs.size() && outputs[o + 1].deflection && outputs[o + 1].element == term.element;
    if (stated)
      section.twist = over_unknowns(system, outputs[o + 1].stiffness);
    else if (const double size = largest_coefficient(given); size > 0.0)
      section.twist = over_unknowns(system, given, 1.0 / size);
    for (std::size_t f = 0; f < system.frequency_terms().size(); ++f)
      if (system.frequency_terms()[f].element == term.element) section.frequency_term = static_cast<int>(f);
    if (!sections.emplace(section.name, section).second) continue;
    in_order.push_back(section.name);
  }
  return sections;
}

}  // namespace

LinearResponse::LinearResponse(const System& system, const LinearSweepOptions& options,
                               const std::vector<double>& orders, std::vector<Finding>& findings)
    : system_(system),
      assembler_(system),
      orders_(orders),
      elimination_(system.pattern()),
      mean_elimination_(system.pattern()) {
  check_model(options.close_contacts, findings);
  content_.emplace(system, orders, findings);
  for (const LoadTerm* load : content_->loads()) load_rows_.push_back(system.row_of(load->node));
  assembler_.contact_values({1.0, 0.0, 0.0}, Contact::closed, mass_);
  assembler_.contact_values({0.0, 1.0, 0.0}, Contact::closed, damping_);
  assembler_.contact_values({0.0, 0.0, 1.0}, Contact::closed, stiffness_);
  find_sections(options.sections, findings);
  if (findings.empty()) prepare_mean(options.balance, findings);
  z_.resize(idx(system.size()));
  p_.resize(idx(system.size()));
}

void LinearResponse::check_model(bool close_contacts, std::vector<Finding>& findings) const {
  const auto refuse = [&](const std::string& place, const std::string& why) {
    findings.push_back({system_.name() + (place.empty() ? "" : "/" + place), "", "", "", why});
  };
  if (system_.size() == 0) refuse("", "every node is prescribed: nothing vibrates");
  if (!system_.reference())
    refuse("", "no shaft turns nominally: orders need a reference shaft (nominal_speed or constant_speed)");
  for (const ScalarTerm& term : system_.scalars()) {
    const std::string name = element_name(system_, term.element);
    if (!close_contacts)
      refuse(name,
             "is not linear; close_contacts (drev sweep --contact closed) takes its stiffness with the "
             "contact closed, at its mean over the mesh");
    if (term.phase_node < 0) continue;
    for (int i = 0; i < 16; ++i)
      if (const Offset offset = term.force->offset(0.7 * i); offset.e != 0.0 || offset.de_dangle != 0.0) {
        refuse(name,
               "has a transmission error, which a linear sweep does not take; harmonic balance "
               "(solve_periodic, drev run --start periodic) does");
        break;
      }
  }
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

void LinearResponse::find_sections(const std::vector<std::string>& names, std::vector<Finding>& findings) {
  std::vector<std::string> wanted;
  std::map<std::string, Section> known = element_sections(system_, wanted);
  const std::vector<Channel> channels =
      names.empty() && system_.scalars().empty() ? std::vector<Channel>{} : all_channels(system_);
  for (const Channel& channel : channels) {
    if (channel.force_of() < 0) continue;
    const ScalarTerm& term = system_.scalars()[idx(channel.force_of())];
    Section section;
    section.name = channel.name();
    section.unit = channel.unit();
    section.twist = term.z;
    section.twist_unit = channel.unit() == "N" ? "m" : "rad";
    section.contact = term.force->gap().has_value();
    for (const Entry& e : term.z) {
      section.stiffness.push_back({e.index, term.force->closed_stiffness() * e.coeff});
      section.damping.push_back({e.index, term.force->closed_damping() * e.coeff});
    }
    section.damper = section.damping;
    known[section.name] = section;
    wanted.push_back(section.name);
  }
  if (!names.empty()) wanted = names;
  for (const std::string& name : wanted) try {
      if (const auto found = known.find(name); found != known.end()) {
        sections_.push_back(found->second);
        continue;
      }
      const Channel channel = find_channel(system_, name);
      if (!channel.is_linear()) {
        findings.push_back({system_.name() + "/sweep", "section", name, "",
                            "is no linear function of the motion; torques and forces of shafts, springs, "
                            "dampers and meshes are, angles, speeds and twists, too"});
        continue;
      }
      Section section;
      section.name = channel.name();
      section.unit = channel.unit();
      section.stiffness = channel.z_row();
      section.damping = channel.v_row();
      sections_.push_back(section);
    } catch (const ModelError& error) {
      findings.insert(findings.end(), error.findings().begin(), error.findings().end());
    }
  if (wanted.empty())
    findings.push_back({system_.name() + "/sweep", "sections", "none", "",
                        "no element of the model carries a torque; name channels, such as NODE.angle_rad"});
}

void LinearResponse::prepare_mean(const std::string& balance, std::vector<Finding>& findings) {
  direction_ = reference_direction(system_);
  floating_ = system_.floating_parts(Contact::closed);
  // A part that floats is held at one node, so that it can be eliminated: a balanced load leaves that node
  // where it is, and the hold without force.
  Vector held = stiffness_, none = Vector::Zero(stiffness_.size());
  std::vector<int> holds;
  std::vector<double> strength;
  for (const std::string& name : floating_) {
    const std::vector<Entry> row = system_.row_of(system_.node(name));
    const int unknown = row.empty() ? 0 : row.front().index;
    const int slot = system_.diagonal_slots()[idx(unknown)];
    holds.push_back(unknown);
    strength.push_back(stiffness_[slot] > 0.0 ? stiffness_[slot] : 1.0);
    held[slot] += strength.back();
  }
  if (!mean_elimination_.factorize(mass_, none, held, 0.0))
    throw SolverError("sweep of " + system_.name() + ": the static stiffness is singular");
  for (std::size_t f = 0; f < floating_.size(); ++f) {
    std::vector<Complex> r(idx(system_.size()));
    r[idx(holds[f])] = strength[f];
    mean_elimination_.solve(r.data());
    Vector shape(system_.size());
    for (int i = 0; i < system_.size(); ++i) shape[i] = r[idx(i)].real();
    const int node = system_.node(floating_[f]);
    const double moves = product(system_.row_of(node), shape), ratio = system_.ratio(node);
    shape *= (ratio != 0.0 ? ratio : 1.0) / moves;
    rigid_.push_back(shape);
    if (ratio == 0.0) dragged_.push_back(f);
  }
  balance_.resize(floating_.size());
  if (balance.empty()) return;
  try {
    const std::vector<Entry> row = system_.row_of(system_.node(balance));
    bool any = false;
    for (std::size_t f = 0; f < rigid_.size(); ++f)
      if (!row.empty() && std::abs(product(row, rigid_[f])) > 1e-9 * rigid_[f].cwiseAbs().maxCoeff())
        balance_[f] = row, any = true;
    if (!any)
      findings.push_back({system_.name() + "/sweep", "balance", balance, "",
                          "must be a node of a part that floats freely; no part there needs a balance"});
  } catch (const ModelError& error) {
    findings.insert(findings.end(), error.findings().begin(), error.findings().end());
  }
}

void LinearResponse::add_frequency_terms(double omega) {
  damping_at_omega_ = damping_here_;
  stiffness_at_omega_ = stiffness_here_;
  const SparseMatrix& pattern = system_.pattern();
  beyond_.clear();
  for (const FrequencyTerm& term : system_.frequency_terms()) {
    const Complex k = term.stiffness->beyond_matrices(omega);
    beyond_.push_back(k);
    for (const Entry& c : term.z)
      for (const Entry& r : term.z) {
        const int* first = pattern.innerIndexPtr() + pattern.outerIndexPtr()[c.index];
        const int* last = pattern.innerIndexPtr() + pattern.outerIndexPtr()[c.index + 1];
        const auto slot = std::lower_bound(first, last, r.index) - pattern.innerIndexPtr();
        stiffness_at_omega_[slot] += k.real() * r.coeff * c.coeff;
        damping_at_omega_[slot] += k.imag() / omega * r.coeff * c.coeff;
      }
  }
}

const Vector& LinearResponse::damping_at(double speed) {
  damping_here_ = damping_;
  stiffness_here_ = stiffness_;
  content_->add_slopes(direction_ * speed, &damping_here_, &stiffness_here_);
  return damping_here_;
}

/// Parts that nothing but dampers ties to the rest (a damper's ring) run at the speed at which their mean torques
/// balance: p -= C R v, R' (p - C R v) = 0.
void LinearResponse::drag_along(Vector& p) const {
  if (dragged_.empty()) return;
  const auto count = static_cast<Eigen::Index>(dragged_.size());
  Eigen::MatrixXd r(system_.size(), count);
  for (Eigen::Index i = 0; i < count; ++i) r.col(i) = rigid_[dragged_[static_cast<std::size_t>(i)]];
  const Eigen::MatrixXd drag = assembler_.product(damping_, r);
  const Eigen::MatrixXd damping = r.transpose() * drag;
  p -= drag * damping.completeOrthogonalDecomposition().solve(r.transpose() * p);
}

void LinearResponse::mean(double speed, Point& point) {
  const auto& contents = content_->at(direction_ * speed);
  Vector p = -direction_ * speed * system_.nominal_drag().head(system_.size());
  // Ratios to rounding leave that of the dampers between nodes of one speed.
  if (p.cwiseAbs().maxCoeff() <= kNoDrag * speed * damping_.cwiseAbs().maxCoeff()) p.setZero();
  point.load_sum = Vector::Zero(static_cast<Eigen::Index>(rigid_.size()));
  point.unbalanced = point.load_sum;
  for (std::size_t f = 0; f < rigid_.size(); ++f)
    point.load_sum[static_cast<Eigen::Index>(f)] += rigid_[f].cwiseProduct(p).cwiseAbs().sum();
  for (std::size_t l = 0; l < contents.size(); ++l) {
    for (const Entry& e : load_rows_[l]) p[e.index] += e.coeff * contents[l].mean;
    for (std::size_t f = 0; f < rigid_.size(); ++f)
      point.load_sum[static_cast<Eigen::Index>(f)] +=
          std::abs(product(load_rows_[l], rigid_[f]) * contents[l].mean);
  }
  drag_along(p);
  for (std::size_t f = 0; f < rigid_.size(); ++f) {
    const Vector& r = rigid_[f];
    const double left = r.dot(p);
    point.unbalanced[static_cast<Eigen::Index>(f)] = left;
    if (!balance_[f].empty()) {
      const double moves = product(balance_[f], r);
      for (const Entry& e : balance_[f]) p[e.index] -= e.coeff * left / moves;
    } else {
      const Vector inertia = assembler_.product(mass_, r);
      p -= inertia * (left / r.dot(inertia));
    }
  }
  std::vector<Complex> z(p.begin(), p.end());
  mean_elimination_.solve(z.data());
  const auto count = static_cast<Eigen::Index>(sections_.size());
  point.mean.resize(count);
  point.twist_mean.resize(count);
  for (Eigen::Index s = 0; s < count; ++s) {
    const Section& section = sections_[static_cast<std::size_t>(s)];
    point.mean[s] = product(section.stiffness, z).real();
    point.twist_mean[s] = product(section.twist, z).real();
  }
}

void LinearResponse::vibration(double speed, Point& point, int only) {
  const auto& contents = content_->at(direction_ * speed);
  if (damping_here_.size() == 0 || content_->follows_speed()) damping_at(speed);
  const auto orders = static_cast<Eigen::Index>(orders_.size()),
             count = static_cast<Eigen::Index>(sections_.size());
  point.amplitude.setZero(orders, count);
  point.twist.setZero(orders, count);
  point.heat.setZero(count);
  point.input_power = point.dissipated_power = 0.0;
  const int* outer = system_.pattern().outerIndexPtr();
  const int* inner = system_.pattern().innerIndexPtr();
  for (Eigen::Index k = 0; k < orders; ++k) {
    if (only >= 0 && k != only) continue;
    std::fill(z_.begin(), z_.end(), Complex(0.0, 0.0));
    bool any = false;
    for (std::size_t l = 0; l < contents.size(); ++l) {
      const Complex c = contents[l].amplitudes[static_cast<std::size_t>(k)];
      if (c == 0.0) continue;
      any = true;
      for (const Entry& e : load_rows_[l]) z_[idx(e.index)] += e.coeff * c;
    }
    if (!any) continue;
    p_ = z_;
    const Complex s(0.0, direction_ * orders_[static_cast<std::size_t>(k)] * speed);
    const bool complex_stiffness = !system_.frequency_terms().empty();
    if (complex_stiffness) add_frequency_terms(std::abs(s.imag()));
    const Vector& damping_values = complex_stiffness ? damping_at_omega_ : damping_here_;
    if (!elimination_.factorize(mass_, damping_values,
                                complex_stiffness ? stiffness_at_omega_ : stiffness_here_, s)) {
      point.amplitude.row(k).setConstant(std::numeric_limits<double>::infinity());
      point.twist.row(k).setConstant(std::numeric_limits<double>::infinity());
      point.heat.setConstant(std::numeric_limits<double>::infinity());
      continue;
    }
    elimination_.solve(z_.data());
    const double rate = std::norm(s);
    for (Eigen::Index c = 0; c < count; ++c) {
      const Section& section = sections_[static_cast<std::size_t>(c)];
      const Complex damping = product(section.damping, z_), twist = product(section.twist, z_);
      // s is imaginary: s times a number turns it.
      point.amplitude(k, c) =
          product(section.stiffness, z_) + Complex(-s.imag() * damping.imag(), s.imag() * damping.real());
      point.twist(k, c) = twist;
      if (section.frequency_term >= 0) {
        // The matrices' torque and what is beyond them; heat = w/2 Im(T conj x). At a negative s k* is conjugate.
        const auto& term = system_.frequency_terms()[idx(section.frequency_term)];
        const Complex beyond = beyond_[idx(section.frequency_term)];
        point.amplitude(k, c) += (s.imag() > 0.0 ? beyond : std::conj(beyond)) * product(term.z, z_);
        point.heat[c] += 0.5 * s.imag() * (point.amplitude(k, c) * std::conj(twist)).imag();
        continue;
      }
      const Complex damper = product(section.damper, z_);
      point.heat[c] += 0.5 * rate * (damper.real() * twist.real() + damper.imag() * twist.imag());
    }
    double dissipated = 0.0, input = 0.0;
    for (int j = 0; j < system_.size(); ++j) {
      const Complex z = z_[idx(j)], p = p_[idx(j)];
      input += s.imag() * (z.real() * p.imag() - z.imag() * p.real());
      for (int e = outer[j]; e < outer[j + 1]; ++e) {
        const Complex other = z_[idx(inner[e])];
        dissipated += damping_values[e] * (z.real() * other.real() + z.imag() * other.imag());
      }
    }
    point.input_power += 0.5 * input;
    point.dissipated_power += 0.5 * rate * dissipated;
  }
}

}  // namespace drev
