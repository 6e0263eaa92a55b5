// What an FMU of another tool is read from, and what is wrong with it; tests/fmi/imported.py runs whole FMUs.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "app/base/temporary_folder.hpp"
#include "app/fmi/import/fmu.hpp"
#include "app/fmi/import/fmu_description.hpp"
#include "app/fmi/import/unzip.hpp"
#include "app/fmi/zip_file.hpp"

namespace drev::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDescription2 = R"(<?xml version="1.0"?>
<fmiModelDescription fmiVersion="2.0" modelName="m" guid="{1}">
  <CoSimulation modelIdentifier="lib" canInterpolateInputs="true"/>
  <ModelVariables>
    <ScalarVariable name="speed" valueReference="3" causality="input"><Real start="0"/></ScalarVariable>
    <ScalarVariable name="torque" valueReference="4" causality="output"><Real/></ScalarVariable>
    <ScalarVariable name="count" valueReference="5" causality="parameter"><Integer start="1" max="9"/></ScalarVariable>
    <ScalarVariable name="inner" valueReference="6"><Enumeration/></ScalarVariable>
  </ModelVariables>
</fmiModelDescription>)";

/// An archive of entries in the folder.
std::string archive(const fs::path& folder, const std::vector<std::pair<std::string, std::string>>& entries) {
  const std::string path = (folder / "a.fmu").string();
  ZipFile zip(path);
  for (const auto& [name, content] : entries) zip.add(name, content);
  zip.commit();
  return path;
}

}  // namespace

TEST_CASE("The description of an FMU of either version is read") {
  const FmuDescription two = read_description(kDescription2);
  CHECK(two.fmi == 2);
  CHECK(two.identifier == "lib");
  CHECK(two.token == "{1}");
  CHECK(two.interpolates_inputs);
  REQUIRE(two.find("speed") != nullptr);
  CHECK(two.find("speed")->reference == 3);
  CHECK(two.find("count")->type == ImportedVariable::Type::integer);
  CHECK(two.find("inner")->type == ImportedVariable::Type::other);
  CHECK(two.find("inner")->causality == "local");
  CHECK(two.names("output") == std::vector<std::string>{"torque"});
  const FmuDescription three = read_description(
      R"(<fmiModelDescription fmiVersion="3.0" instantiationToken="t"><CoSimulation modelIdentifier="l"/>
      <ModelVariables><Float64 name="a" valueReference="1" causality="input" min="-1"><Dimension start="2"/></Float64>
      <Float32 name="b" valueReference="2" causality="output"/></ModelVariables></fmiModelDescription>)");
  CHECK(three.fmi == 3);
  CHECK(three.find("a")->array);
  CHECK(three.find("a")->low == -1.0);
  CHECK(three.find("b")->type == ImportedVariable::Type::other);
  for (const auto& [text, words] : std::vector<std::pair<std::string, std::string>>{
           {"", "line 1"},
           {"<a>", "line 1"},
           {"<a/>", "no fmiModelDescription"},
           {R"(<fmiModelDescription fmiVersion="1.0"/>)", "FMI 1.0"},
           {R"(<fmiModelDescription fmiVersion="3.0"><ModelExchange/></fmiModelDescription>)",
            "no co-simulation"}})
    CHECK_THROWS_WITH(read_description(text), Catch::Contains(words));
}

TEST_CASE("An archive is unpacked inside its folder and within its limits alone") {
  const TemporaryFolder folder;
  const fs::path inside = folder.path / "inside";
  fs::create_directories(inside);
  unzip(archive(folder.path, {{"a/b.txt", "one"}, {"c.txt", std::string(300000, 'x')}}), inside.string());
  CHECK(fs::file_size(inside / "a/b.txt") == 3);
  CHECK(fs::file_size(inside / "c.txt") == 300000);
  for (const char* name : {"../out.txt", "a/../../out.txt", "/out.txt", "a\\out.txt", "c:out.txt"})
    CHECK_THROWS_WITH(unzip(archive(folder.path, {{name, "x"}}), inside.string()),
                      Catch::Contains("leads out of it"));
  CHECK(!fs::exists(folder.path / "out.txt"));
  const std::string large = archive(folder.path, {{"large", std::string(1000, 'x')}});
  CHECK_THROWS_WITH(unzip(large, inside.string(), {.bytes = 999}), Catch::Contains("more than 999 bytes"));
  // The archive's directory says 1 byte of what unpacks to 1000.
  std::fstream file(large, std::ios::in | std::ios::out | std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  file.seekp(static_cast<std::streamoff>(bytes.find("PK\1\2") + 24));
  file.write("\1\0\0\0", 4);
  file.close();
  CHECK_THROWS(unzip(large, inside.string(), {.bytes = 500}));
  CHECK_THROWS_WITH(unzip(archive(folder.path, {{"a", ""}, {"b", ""}}), inside.string(), {.files = 1}),
                    Catch::Contains("holds 2 files"));
  std::ofstream(folder.path / "no.fmu") << "PK no";
  CHECK_THROWS_WITH(unzip((folder.path / "no.fmu").string(), inside.string()),
                    Catch::Contains("no ZIP archive"));
}

TEST_CASE("Folders that killed processes have left are removed, those of living ones stay") {
  const TemporaryFolder place;
  const char* before = std::getenv("TMPDIR");
  const std::string kept = before == nullptr ? "" : before;
  setenv("TMPDIR", place.path.c_str(), 1);
  {
    const TemporaryFolder living;
    const fs::path abandoned = place.path / "drev_fmu_killed", young = place.path / "drev_fmu_young",
                   foreign = place.path / "foreign";
    for (const fs::path& path : {abandoned, young, foreign}) {
      fs::create_directory(path);
      std::ofstream(path / "file") << "text";
    }
    const auto old = fs::file_time_type::clock::now() - std::chrono::hours(1);
    for (const fs::path& path : {abandoned, foreign, living.path}) fs::last_write_time(path, old);
    const TemporaryFolder next;
    CHECK_FALSE(fs::exists(abandoned));
    CHECK(fs::exists(young));
    CHECK(fs::exists(foreign));
    CHECK(fs::exists(living.path));
  }
  if (kept.empty())
    unsetenv("TMPDIR");
  else
    setenv("TMPDIR", kept.c_str(), 1);
}

TEST_CASE("What of an FMU does not fit the model is said with every variable") {
  const TemporaryFolder folder;
  const std::string file = archive(folder.path, {{"modelDescription.xml", kDescription2}});
  const auto findings = [&](Fmu::Params params) {
    params.file = file;
    std::vector<Finding> all;
    ParameterCheck check("m/governor", all);
    Fmu(std::move(params)).check(check);
    std::string text;
    for (const Finding& finding : all) text += finding.text() + "\n";
    return text;
  };
  CHECK(findings({.step = 0.1, .inputs = {{"speed", "time_s"}}, .outputs = {{"torque"}}}).empty());
  const std::string all =
      findings({.step = 0.0,
                .inputs = {{"torque", "time_s"}, {"spead", "time_s"}},
                .outputs = {{"torque"}, {"torque"}},
                .parameters = {{.variable = "count"}, {.variable = "inner", .value = 1.0}}});
  for (const char* words :
       {"step = 0 s", "torque, is an output of the FMU, and must be an input", "did you mean 'speed'?",
        "count, must have a value", "inner, is a local of the FMU", "torque, is there twice"}) {
    INFO(all);
    CHECK_THAT(all, Catch::Contains(words));
  }
  CHECK_THAT(findings({.step = 0.1}), Catch::Contains("must have one a node"));
  // What is no input, and is an output, is not there twice.
  const std::string wrong =
      findings({.step = 0.1, .inputs = {{"torque", "time_s"}}, .outputs = {{"torque"}}});
  CHECK_THAT(wrong, !Catch::Contains("twice"));
  const auto count = [&](double value) {
    return findings(
        {.step = 0.1, .outputs = {{"torque"}}, .parameters = {{.variable = "count", .value = value}}});
  };
  CHECK(count(9.0).empty());
  CHECK_THAT(count(10.0), Catch::Contains("count = 10, must be <= 9, as the FMU declares"));
  for (const double value : {3.4, 4294967299.0, -2147483649.0})  // no rounding into an Integer
    CHECK_THAT(count(value), Catch::Contains("count = " + to_text(value) +
                                             ", is of an integer, which must be a whole number"));
  // There is no library in it: said where a run begins.
  const Fmu fmu({.file = file, .step = 0.1, .outputs = {{"torque"}}});
  CHECK_THROWS_WITH(fmu.open(0.0, 1.0), Catch::Contains("no library for this machine"));
}

}  // namespace drev::app
