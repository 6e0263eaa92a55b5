// The store of a study's rows: what is torn, foreign or not written is not done; what is done is read back.
#include "app/variants/variant_store.hpp"

#include <csignal>
#include <sys/resource.h>

#include "app/base/output_file.hpp"
#include "tests/catch.hpp"
#include "tests/unit/app/process.hpp"

using namespace drev::app;
using drev::test::TemporaryFolder;

namespace {

constexpr StoreShape kShape{.blocks = 5, .numbers = 6};

constexpr std::size_t kPlace = kShape.numbers * sizeof(double) + 3 * sizeof(std::uint64_t);

BlockRows rows_of(double x) {
  BlockRows rows{.numbers = {x, x + 1, x + 2, x + 3, x + 4, x + 5}};
  if (x > 2.0) rows.set_reason(1, "no"), rows.set_reason(2, "neither");
  return rows;
}

std::uint64_t done_in(const std::string& folder, const std::string& description) {
  return VariantStore(folder, description, kShape, true).count();
}

}  // namespace

TEST_CASE("A store keeps its blocks, for its own description only") {
  const TemporaryFolder folder;
  const std::string at = (folder / "r").string();
  CHECK_FALSE(VariantStore::description_in(at));
  {
    VariantStore store(at, "a study", kShape, false);
    store.put(3, rows_of(3.0));
    store.put(0, rows_of(0.5));
    CHECK(store.durable() == 0);
    store.sync();
    CHECK(store.durable() == 2);
    CHECK_THROWS_AS(VariantStore(at, "a study", kShape, true), OutputError);  // one process at a time
  }
  CHECK(VariantStore::description_in(at) == "a study");
  CHECK(VariantStore::progress_in(at) == std::pair<std::uint64_t, std::uint64_t>{2, 5});
  {
    const VariantStore store(at, "a study", kShape, true);
    CHECK(store.count() == 2);
    CHECK(store.done(3));
    CHECK_FALSE(store.done(1));
    CHECK(store.get(3).numbers == rows_of(3.0).numbers);
    CHECK(store.get(3).reasons == std::vector<std::string>{"", "no", "neither"});
    CHECK(store.get(3).reason(2) == "neither");
    CHECK(store.get(3).reason(5).empty());
    CHECK(store.get(0).reasons.empty());
    CHECK_THROWS_AS(store.get(1), OutputError);
  }
  {  // Reasons of later blocks stand behind those that were there.
    VariantStore store(at, "a study", kShape, true);
    store.put(1, rows_of(7.0));
    CHECK(store.get(3).reasons == rows_of(3.0).reasons);
    CHECK(store.get(1).reasons == rows_of(7.0).reasons);
  }
  CHECK(done_in(at, "another study") == 0);
}

TEST_CASE("A reason is cut between two characters of UTF-8") {
  BlockRows rows;
  rows.set_reason(0, std::string(BlockRows::kReason - 1, 'x') + "\u00e9");
  CHECK(rows.reason(0) == std::string(BlockRows::kReason - 1, 'x'));
  CHECK(reasons_in(reasons_as_bytes({"a", "", "b"})) == std::vector<std::string>{"a", "", "b"});
  CHECK(reasons_in("").empty());
}

TEST_CASE("A torn block of a store is not done, wherever it is torn, a torn head is no store") {
  const TemporaryFolder folder;
  const std::string at = (folder / "r").string();
  {
    VariantStore store(at, "a study", kShape, false);
    for (std::uint64_t block = 0; block < kShape.blocks; ++block) store.put(block, rows_of(3.0));
  }
  const std::string path = VariantStore::path_in(at), whole = drev::test::read_file(path);
  const std::size_t place = kPlace, reasons = (whole.size() - 4096) / kShape.blocks - kPlace;
  REQUIRE(reasons == std::string("_no_neither_").size());
  for (std::size_t byte = 0; byte < place; byte += 7) {
    std::string torn = whole;
    torn[4096 + 2 * place + byte] ^= 0x10;
    std::ofstream(path, std::ios::binary) << torn;
    CHECK(done_in(at, "a study") == 4);
  }
  for (std::size_t byte = 0; byte < reasons; ++byte) {
    std::string torn = whole;
    torn[4096 + kShape.blocks * place + 2 * reasons + byte] ^= 0x10;
    std::ofstream(path, std::ios::binary) << torn;
    CHECK(done_in(at, "a study") == 4);
  }
  // As a disk leaves it that had the file's length but not yet its contents.
  std::string torn = whole;
  torn.replace(4096 + place, place, place, '\0');
  std::ofstream(path, std::ios::binary) << torn;
  CHECK(done_in(at, "a study") == 4);
  // Two blocks in each other's places.
  torn = whole.substr(0, 4096) + whole.substr(4096 + place, place) + whole.substr(4096, place) +
         whole.substr(4096 + 2 * place);
  std::ofstream(path, std::ios::binary) << torn;
  CHECK(done_in(at, "a study") == 3);
  std::ofstream(path, std::ios::binary) << whole.substr(0, 30);
  CHECK_FALSE(VariantStore::description_in(at));
  CHECK(done_in(at, "a study") == 0);
}

TEST_CASE("A disk that is too full for a study says so at once, and leaves nothing") {
  const TemporaryFolder folder;
  const std::string at = (folder / "r").string();
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  const auto old = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{10000, before.rlim_max};
  ::setrlimit(RLIMIT_FSIZE, &small);
  std::string said;
  try {
    const VariantStore store(at, "a study", {.blocks = 4000, .numbers = 6}, false);
  } catch (const OutputError& error) {
    said = error.what();
  }
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, old);
  INFO(said);
  CHECK(drev::test::contains(said, "variants.partial.store: "));
  CHECK(drev::test::contains(said, "take 0.292 MB there"));
  CHECK_FALSE(std::filesystem::exists(VariantStore::path_in(at)));
}
