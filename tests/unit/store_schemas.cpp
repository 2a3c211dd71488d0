// Databases of every schema that was released: the present program reads them as they are, leaves them to the older
// program while it refuses a question, and continues them.
#include "sweep/campaign/wrong_question.hpp"
#include "sweep/store/schema.hpp"
#include "sweep/store/store.hpp"
#include "tests/support/archive.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace grainsweep::tests::store_schemas_test {

namespace fs = std::filesystem;
using store::Store;

std::string contents(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

struct Schema : testing::TestWithParam<int> {
    Folder folder;
    fs::path file = folder / "old.db";
    campaign::Campaign asked = small_campaign("old");
    std::vector<campaign::PlacedCase> cases = small_design(asked, 6);
    std::string dump;

    Schema() {
        {
            Store store(file, Store::Mode::create);
            (void)store.enrol(asked, cases, here());
            for (std::size_t k = 0; k < 3; ++k) settle(store, cases[k].question, 1);
            dump = dump_of(store);
        }
        take_back_to_schema(GetParam(), file);
    }
    /// In the header of the file: https://www.sqlite.org/fileformat.html, 1.3.
    [[nodiscard]] int version() const {
        constexpr std::size_t lowest_byte_of_user_version = 63;
        return contents(file).at(lowest_byte_of_user_version);
    }
};

TEST_P(Schema, IsReadAsItIs) {
    const Store store(file, Store::Mode::read);
    EXPECT_EQ(dump_of(store), dump);
    EXPECT_EQ(store.campaigns().size(), 1U);
    EXPECT_EQ(store.status().rows.size(), 1U);
    EXPECT_TRUE(contents(folder / "old.db-wal").empty());
    EXPECT_EQ(store.verify().size(), 0U);
    EXPECT_EQ(version(), GetParam());
}

TEST_P(Schema, IsLeftToTheOlderProgramByAQuestionThatIsRefused) {
    const auto before = contents(file);
    {
        Store store(file, Store::Mode::create);
        auto other = asked;
        other.seed = 77;
        EXPECT_THROW((void)store.enrol(other, small_design(other, 6), here()), campaign::WrongQuestion);
    }
    EXPECT_EQ(version(), GetParam());
    EXPECT_TRUE(contents(file) == before) << "to the byte";
}

TEST_P(Schema, IsContinued) {
    {
        Store store(file, Store::Mode::create);
        const auto states = store.enrol(asked, cases, here());
        EXPECT_EQ(states[2].outcome, campaign::Outcome::completed);
        EXPECT_FALSE(states[3].outcome);
        EXPECT_EQ(dump_of(store), dump) << "no answer has changed";
        for (std::size_t k = 3; k < 6; ++k) settle(store, cases[k].question, 1);
        store.remember_file();
    }
    EXPECT_EQ(version(), static_cast<int>(store::schema_migrations().size()));
    EXPECT_TRUE(Store(file, Store::Mode::read).verify().empty());
}

INSTANTIATE_TEST_SUITE_P(Released, Schema, testing::Values(1, 2, 4, 5, 6, 7, 8, 9),
                         [](const auto& one) { return "Schema" + std::to_string(one.param); });

}  // namespace grainsweep::tests::store_schemas_test
