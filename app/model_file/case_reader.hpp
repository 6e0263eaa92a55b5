#pragma once
/// From the sections of a model file, with values for its parameters, to a model case.
#include <drev/app/model_file/model_file.hpp>

#include <functional>
#include <set>
#include <string>

#include "app/model_file/document.hpp"
#include "app/model_file/read_values.hpp"

namespace drev::app {

struct FileCase {
  std::optional<ModelCase> model_case;  ///< none where something is wrong
  RunOptions options;
  std::vector<Finding> findings;
};

/// Goes through the nodes and elements of blocks as a model file means them: as often as the block is repeated, with the
/// counter in the context's scope, and without those whose condition does not hold.
class BlockEntries {
 public:
  using Use = std::function<void(const Entry& entry, const std::string& name)>;
  explicit BlockEntries(ReadContext& context) : context_(context) {}
  /// Faults go to the context's findings; where there are too many, or too many entries, the rest is left out.
  void for_each(const Block& block, const Value& table, const Use& use);
  /// False where a fault kept some from being gone through, or left open how many there are.
  bool all_read() const { return all_read_; }

 private:
  bool is_wanted(const Entry& when, const std::string& name);
  bool too_many_faults();

  ReadContext& context_;
  std::set<const Block*> seen_;
  std::size_t read_ = 0;
  bool too_many_ = false, all_read_ = true;
};

/// What values of the file are read with.
ReadContext context_of(const Document& document, const Parameters& parameters);

/// `run` as in ModelFile. With options_only, nodes and elements are passed over and there is no model case.
FileCase read_case(const Document& document, const Parameters& parameters, const std::string& run,
                   bool options_only = false);

/// Values for parameters that [run] and the named run set: laid over the defaults.
void set_run_parameters(const Document& document, const std::string& run, std::vector<Parameter>& parameters,
                        std::vector<Finding>& findings);

}  // namespace drev::app
