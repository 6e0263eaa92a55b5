#pragma once
/// [run] of a model file and the named runs inside it.
#include <drev/core/system.hpp>

#include "app/model_file/case_reader.hpp"
#include "app/model_file/part.hpp"

namespace drev::app {

class RunSection {
 public:
  /// Reads [run], then what the named run changes; what is wrong goes to the context.
  RunSection(const Document& document, const std::string& run, ReadContext& context);

  RunOptions options() const;
  /// What the runs of the model need to know. Channels that do not exist are findings, unless they may be of what the
  /// system leaves out.
  void complete(ModelCase& model_case, const System& system, const LeftOut& left_out,
                ReadContext& context) const;

 private:
  void set_span(ModelCase& model_case) const;
  struct Params {
    double duration = 1.0, step = 1e-4, static_turn = 0.0;
    double every, tolerance, accuracy, settle_time;
    std::string method, out, deflection, start, settle;
    std::vector<std::string> torques, record;
    Params();
  };
  static void list(Fields& f, Params& p);
  /// The last entry of the key, with or without a unit; null if there is none.
  const Entry* entry(const std::string& key) const;
  std::vector<std::string> channels(const std::string& key, const std::vector<std::string>& asked,
                                    const System& system, const LeftOut& left_out,
                                    ReadContext& context) const;

  std::vector<const Value*> tables_;  ///< [run], then the named run
  Params params_;
};

}  // namespace drev::app
