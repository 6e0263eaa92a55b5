#include "solvers/periodic/lane_sections.hpp"

namespace drev {

namespace {

DREV_WIDEST void row_sums(int rows, const int* begin, const int* index, const double* coeff, const LaneRow* z,
                          LaneRow* sums) {
  for (int r = 0; r < rows; ++r) {
    Lanes sum{};
    for (int e = begin[r]; e < begin[r + 1]; ++e) sum += coeff[e] * z[index[e]].v;
    sums[r].v = sum;
  }
}

template <class Value>
[[gnu::always_inline]] inline void powers(int n, const int* outer, const int* inner, const Value* damping,
                                          const Lanes& w, const LaneRow* p_re, const LaneRow* p_im,
                                          const LaneRow* re, const LaneRow* im, Lanes& input,
                                          Lanes& dissipated) {
  Lanes in{}, lost{};
  for (int j = 0; j < n; ++j) {
    in += re[j].v * p_im[j].v - im[j].v * p_re[j].v;
    Lanes force_re{}, force_im{};
    for (int e = outer[j]; e < outer[j + 1]; ++e) {
      force_re += each(damping[e]) * re[inner[e]].v;
      force_im += each(damping[e]) * im[inner[e]].v;
    }
    lost += re[j].v * force_re + im[j].v * force_im;
  }
  input = 0.5 * w * in;
  dissipated = 0.5 * w * w * lost;
}

DREV_WIDEST void powers_common(int n, const int* outer, const int* inner, const double* damping,
                               const Lanes& w, const LaneRow* p_re, const LaneRow* p_im, const LaneRow* re,
                               const LaneRow* im, Lanes& input, Lanes& dissipated) {
  powers(n, outer, inner, damping, w, p_re, p_im, re, im, input, dissipated);
}
DREV_WIDEST void powers_each(int n, const int* outer, const int* inner, const LaneRow* damping,
                             const Lanes& w, const LaneRow* p_re, const LaneRow* p_im, const LaneRow* re,
                             const LaneRow* im, Lanes& input, Lanes& dissipated) {
  powers(n, outer, inner, damping, w, p_re, p_im, re, im, input, dissipated);
}

}  // namespace

LaneSections::LaneSections(const System& system, const std::vector<SectionRows>& sections) {
  begin_.push_back(0);
  const auto add = [this](const std::vector<Entry>& row) {
    for (const Entry& e : row) {
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

namespace {

/// i w times a number turns it. With a frequency term: the matrices' torque and what is beyond them; heat = w/2 Im(T conj x).
DREV_WIDEST void torques(int sections, const int* term, const LaneRow* re, const LaneRow* im, const Lanes& w,
                         const LaneRow* k_re, const LaneRow* k_im, LaneSections::Result* results) {
  using Rows = LaneSections;
  for (int s = 0; s < sections; ++s, re += Rows::kRows, im += Rows::kRows) {
    const Lanes twist_re = re[Rows::twist].v, twist_im = im[Rows::twist].v;
    Lanes torque_re = re[Rows::stiffness].v - w * im[Rows::damping].v,
          torque_im = im[Rows::stiffness].v + w * re[Rows::damping].v;
    Lanes heat = 0.5 * w * w * (re[Rows::damper].v * twist_re + im[Rows::damper].v * twist_im);
    if (term[s] >= 0) {
      const Lanes a = k_re[term[s]].v, b = k_im[term[s]].v;
      torque_re += a * re[Rows::beyond].v - b * im[Rows::beyond].v;
      torque_im += a * im[Rows::beyond].v + b * re[Rows::beyond].v;
      heat = 0.5 * w * (torque_im * twist_re - torque_re * twist_im);
    }
    results[s].torque.re = torque_re, results[s].torque.im = torque_im;
    results[s].twist.re = twist_re, results[s].twist.im = twist_im;
    results[s].heat = heat;
  }
}

DREV_WIDEST void add_rows(int count, const int* slots, const int* terms, const double* times,
                          const LaneRow* additions, const double* common, LaneRow* values) {
  for (int i = 0; i < count; ++i) values[slots[i]].v = Lanes{} + common[slots[i]];
  for (int i = 0; i < count; ++i) values[slots[i]].v += times[i] * additions[terms[i]].v;
}

}  // namespace

void add_at_slots(const std::vector<int>& slots, const std::vector<int>& terms,
                  const std::vector<double>& times, const LaneArray& additions, const double* common,
                  LaneRow* values) {
  add_rows(static_cast<int>(slots.size()), slots.data(), terms.data(), times.data(), additions.data(), common,
           values);
}

void LaneSections::find(const LaneArray& re, const LaneArray& im, const Lanes& w, const LaneArray& k_re,
                        const LaneArray& k_im) {
  const auto rows = static_cast<int>(re_.size());
  row_sums(rows, begin_.data(), index_.data(), coeff_.data(), re.data(), re_.data());
  row_sums(rows, begin_.data(), index_.data(), coeff_.data(), im.data(), im_.data());
  torques(static_cast<int>(term_.size()), term_.data(), re_.data(), im_.data(), w, k_re.data(), k_im.data(),
          results_.data());
}

void lane_powers(const SparseMatrix& pattern, const double* damping, const Lanes& w, const LaneArray& p_re,
                 const LaneArray& p_im, const LaneArray& re, const LaneArray& im, Lanes& input,
                 Lanes& dissipated) {
  powers_common(static_cast<int>(pattern.cols()), pattern.outerIndexPtr(), pattern.innerIndexPtr(), damping,
                w, p_re.data(), p_im.data(), re.data(), im.data(), input, dissipated);
}

void lane_powers(const SparseMatrix& pattern, const LaneRow* damping, const Lanes& w, const LaneArray& p_re,
                 const LaneArray& p_im, const LaneArray& re, const LaneArray& im, Lanes& input,
                 Lanes& dissipated) {
  powers_each(static_cast<int>(pattern.cols()), pattern.outerIndexPtr(), pattern.innerIndexPtr(), damping, w,
              p_re.data(), p_im.data(), re.data(), im.data(), input, dissipated);
}

}  // namespace drev
