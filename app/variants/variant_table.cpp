#include "app/variants/variant_table.hpp"

#include <drev/core/version.hpp>

#include <algorithm>
#include <cmath>

#include "app/base/output_file.hpp"
#include "app/base/text_layout.hpp"
#include "app/cli/exit_codes.hpp"
#include "app/results/hdf5_file.hpp"

namespace drev::app {

namespace {

constexpr std::uint64_t kRowsAtOnce = 65536;  // rows in memory at once
constexpr std::size_t kFailuresTold = 20;     // largest number of failures listed as text

}  // namespace

std::string table_path(const std::string& folder) { return folder + "/variants.h5"; }

std::size_t text_size(const Varied& varied) {
  if (varied.kind == Varied::Kind::orders) return order_text(0, varied.items).size();
  std::size_t size = 0;
  bool numbers = true;
  double value = 0.0;
  for (const std::string& text : varied.values) {
    numbers = numbers && read_number(text, value);
    size = std::max(size, text.size());
  }
  return numbers ? 0 : size;
}

std::string unit_of(const VariantStudy& study, const std::string& name) {
  for (const Parameter& p : study.request().model.parameters.known())
    if (p.name == name) return p.unit;
  return {};
}

namespace {

Json varied_object(const VariantStudy& study, std::uint64_t variant) {
  return values_object(study.plan().parameters(variant));
}

std::string varied_text(const VariantStudy& study, std::uint64_t variant) {
  std::vector<std::string> parts;
  for (const auto& [name, text] : study.plan().parameters(variant)) parts.push_back(name + "=" + text);
  return join(parts);
}

Json figure_object(const VariantStudy& study, const FigureStatistics& s) {
  const bool any = s.count > 0;
  const auto extreme = [&](double value, std::uint64_t at) {
    return any ? Json{{"value", number(value)}, {"variant", at}, {"varied", varied_object(study, at)}}
               : Json();
  };
  Json object{{"name", s.column.name},
              {"unit", s.column.unit},
              {"count", s.count},
              {"mean", any ? number(s.mean) : Json()},
              {"mean_error", number(s.mean_error)},
              {"deviation", any ? number(s.deviation) : Json()},
              {"min", extreme(s.min, s.at_min)},
              {"max", extreme(s.max, s.at_max)},
              {"quantiles", Json::array()},
              {"histogram", s.histogram},
              {"sobol", Json::array()}};
  for (const Quantile& q : s.quantiles)
    object["quantiles"].push_back(
        {{"part", q.part}, {"value", number(q.value)}, {"low", number(q.low)}, {"high", number(q.high)}});
  for (std::size_t j = 0; j < s.indices.size(); ++j)
    object["sobol"].push_back({{"parameter", study.plan().varied()[j].name},
                               {"first", number(s.indices[j].first)},
                               {"first_error", number(1.96 * s.indices[j].first_error)},
                               {"total", number(s.indices[j].total)},
                               {"total_error", number(1.96 * s.indices[j].total_error)}});
  return object;
}

struct Remark {
  std::uint64_t variant;
  VariantStatus status;
  std::string reason;
};

/// What there is to say of single variants: the first that failed and the first with a warning, up to kFailuresKept each.
struct Remarks {
  std::vector<Remark> failures, warnings;
  std::uint64_t warned = 0;  ///< how many have a warning
};

Remarks remarks_of(const VariantStudy& study, const VariantStore& store) {
  Remarks all;
  for (std::uint64_t block = 0; block < study.blocks(); ++block) {
    const BlockRows rows = store.get(block);
    for (std::uint64_t i = 0; i < study.count_of(block); ++i) {
      const auto status = static_cast<VariantStatus>(static_cast<int>(rows.numbers[i * study.row_size()]));
      const bool failed = status != VariantStatus::success;
      if (!failed && rows.reason(i).empty()) continue;
      if (!failed) ++all.warned;
      std::vector<Remark>& list = failed ? all.failures : all.warnings;
      if (list.size() < kFailuresKept) list.push_back({study.first_of(block) + i, status, rows.reason(i)});
    }
  }
  return all;
}

/// The first remarks as text; `of` in all; what: "more failed", of those that are left out.
std::string remarks_text(const VariantStudy& study, const std::vector<Remark>& remarks, std::uint64_t of,
                         const std::string& what, const std::string& folder) {
  std::string text;
  for (std::size_t i = 0; i < std::min(kFailuresTold, remarks.size()); ++i) {
    const Remark& r = remarks[i];
    text += wrap("variant " + std::to_string(r.variant) + " (" + varied_text(study, r.variant) +
                     "): " + (r.status == VariantStatus::success ? "warning" : status_text(r.status)) + ": " +
                     r.reason,
                 2);
  }
  if (of > kFailuresTold)
    text += "  " + std::to_string(of - kFailuresTold) + " " + what + "; " + folder + "/variants.json lists " +
            (of > remarks.size() ? "the first " + std::to_string(remarks.size()) : "all") + "\n";
  return text;
}

std::string figures_text(const VariantStudy& study, const VariantStatistics& statistics) {
  std::vector<std::vector<std::string>> rows{
      {"figure", "mean", "deviation", "least", "5 %", "median", "95 %", "largest"}};
  for (const FigureStatistics& s : statistics.figures()) {
    if (s.count == 0) continue;
    const std::string unit = s.column.unit.empty() ? "" : " [" + s.column.unit + "]";
    rows.push_back({s.column.name + unit,
                    short_digits(s.mean, 5) +
                        (std::isfinite(s.mean_error) ? " +- " + short_digits(s.mean_error, 2) : ""),
                    short_digits(s.deviation, 4), short_digits(s.min, 5),
                    short_digits(s.quantiles[1].value, 4), short_digits(s.quantiles[2].value, 4),
                    short_digits(s.quantiles[3].value, 4), short_digits(s.max, 5)});
  }
  std::string text = columns_text(rows);
  for (const FigureStatistics& s : statistics.figures()) {
    if (s.indices.empty()) continue;
    text += "\nSobol indices of " + s.column.name + ", first order and total, with 95 % intervals\n";
    std::vector<std::vector<std::string>> table{{"parameter", "first", "+-", "total", "+-"}};
    for (std::size_t j = 0; j < s.indices.size(); ++j) {
      const SobolIndex& index = s.indices[j];
      table.push_back({study.plan().varied()[j].name, digits(index.first, 3),
                       digits(1.96 * index.first_error, 2), digits(index.total, 3),
                       digits(1.96 * index.total_error, 2)});
    }
    text += columns_text(table);
  }
  return text;
}

}  // namespace

VariantStatistics statistics_of(const VariantStudy& study, const VariantStore& store) {
  VariantStatistics statistics(study);
  for (const bool again : {false, true})
    for (std::uint64_t block = 0; block < study.blocks(); ++block) {
      const BlockRows rows = store.get(block);
      for (std::uint64_t i = 0; i < study.count_of(block); ++i) {
        const double* row = rows.numbers.data() + i * study.row_size();
        if (again)
          statistics.look_again(study.first_of(block) + i, row);
        else
          statistics.look(study.first_of(block) + i, row);
      }
    }
  statistics.finish();
  return statistics;
}

VariantSummary summary_of(const VariantStudy& study, const VariantStatistics& statistics,
                          const VariantStore& store, const std::string& folder) {
  const std::uint64_t count = study.plan().count(), good = statistics.count(VariantStatus::success);
  VariantSummary summary;
  Json& json = summary.json;
  json = {{"$schema", "urn:drev:variants:1"}, {"kind", "variants"}, {"drev", DREV_VERSION}};
  json["status"] = good == count ? "success" : "failed";
  json["study"] = study.description();
  json["study"].erase("files");
  json["lockstep"] = study.why_not_lockstep().empty();
  json["why_not_lockstep"] = text_or_null(study.why_not_lockstep());
  json["statuses"] = Json::object();
  std::vector<std::string> counts;
  for (int i = 0; i < kVariantStatuses; ++i) {
    const auto status = static_cast<VariantStatus>(i);
    json["statuses"][status_text(status)] = statistics.count(status);
    if (statistics.count(status) > 0)
      counts.push_back(std::to_string(statistics.count(status)) + " " + status_text(status));
  }
  summary.exit_code = exit_code_of(json);
  json["figures"] = Json::array();
  for (const FigureStatistics& s : statistics.figures()) json["figures"].push_back(figure_object(study, s));
  const Remarks remarks = remarks_of(study, store);
  json["failures"] = json["warnings"] = Json::array();
  for (const Remark& f : remarks.failures)
    json["failures"].push_back({{"variant", f.variant},
                                {"status", status_text(f.status)},
                                {"varied", varied_object(study, f.variant)},
                                {"reason", f.reason}});
  for (const Remark& w : remarks.warnings)
    json["warnings"].push_back(
        {{"variant", w.variant}, {"varied", varied_object(study, w.variant)}, {"warning", w.reason}});

  std::string& text = summary.text;
  const Method& method = study.request().method;
  text = labelled("variants", std::to_string(count) + " of " + study.request().words + ": " + join(counts)) +
         labelled("method", to_text(method) + (study.why_not_lockstep().empty()
                                                   ? ", eight variants in lockstep"
                                                   : ", one by one: " + study.why_not_lockstep())) +
         "\n" + figures_text(study, statistics) + "\n";
  summary.remarks = remarks_text(study, remarks.failures, count - good, "more failed", folder) +
                    remarks_text(study, remarks.warnings, remarks.warned, "more have a warning", folder);
  text += summary.remarks + labelled("table", table_path(folder));
  return summary;
}

void write_variant_table(const VariantStudy& study, const VariantStore& store, const std::string& folder,
                         const std::string& summary) {
  const std::uint64_t count = study.plan().count();
  OutputFile file(folder, "variants", "h5");
  {
    Hdf5File h5(file.partial_path());
    h5.add_text("drev", DREV_VERSION);
    h5.add_text("study", study.description().dump());
    h5.add_text("summary", summary);
    const std::vector<Varied>& varied = study.plan().varied();
    for (const Varied& v : varied)
      h5.add_column(
          {.name = v.name, .unit = unit_of(study, v.name), .rows = count, .text_size = text_size(v)});
    std::vector<std::string> meanings;
    for (int i = 0; i < kVariantStatuses; ++i) meanings.push_back(status_text(static_cast<VariantStatus>(i)));
    h5.add_column({.name = "status", .rows = count, .meanings = meanings});
    for (const FigureColumn& f : study.figures())
      h5.add_column({.name = f.name, .unit = f.unit, .rows = count});

    const std::size_t row_size = study.row_size();
    std::vector<std::vector<std::string>> texts(varied.size());
    std::vector<std::vector<double>> numbers(varied.size()), columns(row_size);
    std::uint64_t at = 0;
    const auto empty_rows = [&] {
      const std::uint64_t rows = columns[0].size();
      for (std::size_t c = 0; c < varied.size(); ++c) {
        if (numbers[c].empty())
          h5.write(c, at, texts[c]);
        else
          h5.write(c, at, numbers[c]);
        texts[c].clear(), numbers[c].clear();
      }
      for (std::size_t c = 0; c < row_size; ++c) {
        h5.write(varied.size() + c, at, columns[c]);
        columns[c].clear();
      }
      at += rows;
    };
    std::vector<bool> text_column;
    for (const Varied& v : varied) text_column.push_back(text_size(v) > 0);
    for (std::uint64_t block = 0; block < study.blocks(); ++block) {
      const BlockRows rows = store.get(block);
      for (std::uint64_t i = 0; i < study.count_of(block); ++i) {
        const ParameterValues values = study.plan().parameters(study.first_of(block) + i);
        for (std::size_t c = 0; c < varied.size(); ++c) {
          double value = 0.0;
          if (text_column[c])
            texts[c].push_back(values[c].second);
          else if (read_number(values[c].second, value))
            numbers[c].push_back(value);
        }
        for (std::size_t c = 0; c < row_size; ++c) columns[c].push_back(rows.numbers[i * row_size + c]);
      }
      if (columns[0].size() + study.block_size() > kRowsAtOnce) empty_rows();
    }
    if (!columns[0].empty()) empty_rows();
    h5.close();
  }
  file.commit();
}

std::optional<Json> study_of_table(const std::string& folder) {
  const auto text = hdf5_text(table_path(folder), "study");
  if (!text) return {};
  Json json = Json::parse(*text, nullptr, false);
  return json.is_object() ? std::optional(std::move(json)) : std::nullopt;
}

std::optional<Json> summary_of_table(const std::string& folder) {
  const auto text = hdf5_text(table_path(folder), "summary");
  if (!text) return {};
  Json json = Json::parse(*text, nullptr, false);
  return json.is_object() ? std::optional(std::move(json)) : std::nullopt;
}

int exit_code_of(const Json& summary) {
  std::uint64_t failed = 0;
  const std::string success = status_text(VariantStatus::success),
                    bad_input = status_text(VariantStatus::bad_input);
  const Json statuses = summary.value("statuses", Json::object());
  for (const auto& [status, count] : statuses.items())
    if (status != success) failed += count.get<std::uint64_t>();
  if (failed == 0) return summary.value("status", "") == success ? kSuccess : kNotTrusted;
  return statuses.value(bad_input, std::uint64_t{0}) == failed ? kBadInput : kNotTrusted;
}

}  // namespace drev::app
