#include "solvers/periodic/lane_sections.hpp"

#include "solvers/linear/lane_pair.hpp"

namespace drev {

namespace {

/// Computes the products of rows with z.
struct RowSums {
  template <class L>
  [[gnu::always_inline]] static void run(int rows, const int* begin, const int* index, const double* coeff,
                                         const LaneRow* re, const LaneRow* im, LaneRow* sums_re,
                                         LaneRow* sums_im) {
    for (int r = 0; r < rows; ++r) {
      L sum_re{}, sum_im{}, x;
      for (int e = begin[r]; e < begin[r + 1]; ++e) {
        take(re[index[e]], x), sum_re += coeff[e] * x;
        take(im[index[e]], x), sum_im += coeff[e] * x;
      }
      put(sum_re, sums_re[r]), put(sum_im, sums_im[r]);
    }
  }
};

/// Powers with damping values common to all lanes (Value: double), or with those of each lane (LaneRow).
template <class Value>
struct FindPowersOf {
  template <class L>
  [[gnu::always_inline]] static void run(int columns, const int* unknowns, const int* outer, const int* inner,
                                         const int* slots, const Value* damping, const LaneRow* frequencies,
                                         const LaneRow* p_re, const LaneRow* p_im, const LaneRow* re,
                                         const LaneRow* im, LaneSections::Powers* found) {
    L in{}, lost{}, w;
    for (int j = 0; j < columns; ++j) {
      const int unknown = unknowns[j];
      L x_re, x_im, of_re, of_im, c, force_re{}, force_im{};
      take(re[unknown], x_re), take(im[unknown], x_im);
      take(p_re[unknown], of_re), take(p_im[unknown], of_im);
      in += x_re * of_im - x_im * of_re;
      for (int e = outer[j]; e < outer[j + 1]; ++e) {
        take(damping[slots[e]], c), take(re[inner[e]], of_re), take(im[inner[e]], of_im);
        force_re += c * of_re;
        force_im += c * of_im;
      }
      lost += x_re * force_re + x_im * force_im;
    }
    take(*frequencies, w);
    put(0.5 * w * in, found->input);
    put(0.5 * w * w * lost, found->dissipated);
  }
};

/// Torques, twists and heat from the products of rows with z. Rates are i w times the deflections. With a
/// frequency term, the torque is that of the matrices plus the part beyond them, and heat = w/2 Im(T conj x).
struct Torques {
  template <class L>
  [[gnu::always_inline]] static void run(int sections, const int* term, const LaneRow* re, const LaneRow* im,
                                         const LaneRow* frequencies, const LaneRow* k_re, const LaneRow* k_im,
                                         LaneSections::Result* results) {
    using Rows = LaneSections;
    L w;
    take(*frequencies, w);
    for (int s = 0; s < sections; ++s, re += Rows::kRows, im += Rows::kRows) {
      L twist_re, twist_im, torque_re, torque_im, row_re, row_im;
      take(re[Rows::twist], twist_re), take(im[Rows::twist], twist_im);
      take(re[Rows::stiffness], torque_re), take(im[Rows::stiffness], torque_im);
      take(re[Rows::damping], row_re), take(im[Rows::damping], row_im);
      torque_re -= w * row_im;
      torque_im += w * row_re;
      take(re[Rows::damper], row_re), take(im[Rows::damper], row_im);
      L heat = 0.5 * w * w * (row_re * twist_re + row_im * twist_im);
      if (term[s] >= 0) {
        L a, b;
        take(k_re[term[s]], a), take(k_im[term[s]], b);
        take(re[Rows::beyond], row_re), take(im[Rows::beyond], row_im);
        torque_re += a * row_re - b * row_im;
        torque_im += a * row_im + b * row_re;
        heat = 0.5 * w * (torque_im * twist_re - torque_re * twist_im);
      }
      put(torque_re, results[s].torque.re), put(torque_im, results[s].torque.im);
      put(twist_re, results[s].twist.re), put(twist_im, results[s].twist.im);
      put(heat, results[s].heat);
    }
  }
};

struct AddAtSlots {
  template <class L>
  [[gnu::always_inline]] static void run(int count, const int* slots, const int* terms, const double* times,
                                         const LaneRow* additions, const double* common, LaneRow* values) {
    L x, sum;
    for (int i = 0; i < count; ++i) take(common[slots[i]], x), put(x, values[slots[i]]);
    for (int i = 0; i < count; ++i) {
      take(additions[terms[i]], x), take(values[slots[i]], sum);
      put(sum + times[i] * x, values[slots[i]]);
    }
  }
};

}  // namespace

LaneSections::LaneSections(const System& system, const std::vector<SectionRows>& sections,
                           const std::vector<bool>& held) {
  const SparseMatrix& pattern = system.pattern();
  outer_.push_back(0);
  for (int j = 0; j < system.size(); ++j) {
    if (held[idx(j)]) continue;
    unknowns_.push_back(j);
    for (int slot = pattern.outerIndexPtr()[j]; slot < pattern.outerIndexPtr()[j + 1]; ++slot)
      if (const int row = pattern.innerIndexPtr()[slot]; !held[idx(row)])
        inner_.push_back(row), slots_.push_back(slot);
    outer_.push_back(static_cast<int>(inner_.size()));
  }
  begin_.push_back(0);
  const auto add = [&](const std::vector<Entry>& row) {
    for (const Entry& e : row) {
      if (held[idx(e.index)]) continue;
      index_.push_back(e.index);
      coeff_.push_back(e.coeff);
    }
    begin_.push_back(static_cast<int>(index_.size()));
  };
  for (const SectionRows& s : sections) {
    add(s.stiffness);
    add(s.damping);
    add(s.twist);
    add(s.damper);
    term_.push_back(s.frequency_term);
    add(s.frequency_term < 0 ? std::vector<Entry>{} : system.frequency_terms()[idx(s.frequency_term)].z);
  }
  re_.resize(begin_.size() - 1);
  im_.resize(begin_.size() - 1);
  results_.resize(sections.size());
}

void add_at_slots(const std::vector<int>& slots, const std::vector<int>& terms,
                  const std::vector<double>& times, const LaneArray& additions, const double* common,
                  LaneRow* values) {
  run_widest<AddAtSlots>(static_cast<int>(slots.size()), slots.data(), terms.data(), times.data(),
                         additions.data(), common, values);
}

void LaneSections::find(const LaneArray& re, const LaneArray& im, const Lanes& w, const LaneArray& k_re,
                        const LaneArray& k_im) {
  const auto rows = static_cast<int>(re_.size());
  const LaneRow frequencies{w};
  run_widest<RowSums>(rows, begin_.data(), index_.data(), coeff_.data(), re.data(), im.data(), re_.data(),
                      im_.data());
  run_widest<Torques>(static_cast<int>(term_.size()), term_.data(), re_.data(), im_.data(), &frequencies,
                      k_re.data(), k_im.data(), results_.data());
}

LaneSections::Powers LaneSections::powers(const double* damping, const Lanes& w, const LaneArray& p_re,
                                          const LaneArray& p_im, const LaneArray& re,
                                          const LaneArray& im) const {
  const LaneRow frequencies{w};
  Powers found;
  run_widest<FindPowersOf<double>>(static_cast<int>(unknowns_.size()), unknowns_.data(), outer_.data(),
                                   inner_.data(), slots_.data(), damping, &frequencies, p_re.data(),
                                   p_im.data(), re.data(), im.data(), &found);
  return found;
}

LaneSections::Powers LaneSections::powers(const LaneRow* damping, const Lanes& w, const LaneArray& p_re,
                                          const LaneArray& p_im, const LaneArray& re,
                                          const LaneArray& im) const {
  const LaneRow frequencies{w};
  Powers found;
  run_widest<FindPowersOf<LaneRow>>(static_cast<int>(unknowns_.size()), unknowns_.data(), outer_.data(),
                                    inner_.data(), slots_.data(), damping, &frequencies, p_re.data(),
                                    p_im.data(), re.data(), im.data(), &found);
  return found;
}

}  // namespace drev
