// Files cut short, overwritten with zeros or with noise: a sentence, or an answer, never a crash.
#include "stats/random.hpp"
#include "sweep/campaign/input_error.hpp"
#include "tests/support/whole_campaign.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

namespace grainsweep::tests::store_damage_test {

using store::Store;

std::string contents(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}
void write(const std::filesystem::path& file, std::string_view text) {
    std::ofstream(file, std::ios::binary) << text;
}

enum class Finding { answered, refused };

/// Asks everything; an exception of another kind goes to the test, a crash ends it.
Finding ask_everything(const WholeCampaign& whole, const std::filesystem::path& file, Store::Mode mode) {
    try {
        Store store(file, mode);
        (void)store.status();
        (void)store.campaigns();
        (void)dump_of(store);
        (void)store.query("SELECT * FROM inputs");
        for (const auto& record : store.campaigns()) {
            try {
                (void)store.values(record.name, "y");
            } catch (const campaign::InputError&) {  // a name may have been hit
            }
        }
        for (const auto& it : whole.cases) {
            (void)store.find_case(it.question.id);
            (void)store.result(it.question.id);
            (void)store.attempts(it.question.id);
        }
        if (mode == Store::Mode::create) store.enrol(whole.campaign, whole.cases, here());
        return Finding::answered;
    } catch (const SystemError&) {
    } catch (const campaign::InputError&) {
    }
    return Finding::refused;
}

struct StoreDamage : testing::Test {
    WholeCampaign whole{40};
    Folder folder;
    std::string database;
    std::string log;       ///< of a writer that is still at work
    std::string unmerged;  ///< the database as it lies beside that log

    StoreDamage() {
        whole.run(folder / "a.db", [](std::size_t) {});
        database = contents(folder / "a.db");
        std::size_t groups = 0;
        whole.run(folder / "b.db", [&](std::size_t) {
            if (++groups < 6) return;
            log = contents(folder / "b.db-wal");
            unmerged = contents(folder / "b.db");
        });
    }
};

TEST_F(StoreDamage, ADatabaseCutShortOrZeroed) {
    int refused = 0;
    for (std::size_t length = 0; length < database.size(); length += 1777) {
        for (const bool zeros : {false, true}) {
            const Folder place;
            std::string text = database.substr(0, length);
            if (zeros) text.resize(database.size(), '\0');
            write(place / "c.db", text);
            refused += ask_everything(whole, place / "c.db", Store::Mode::read) == Finding::refused ? 1 : 0;
            if (length > 0) ask_everything(whole, place / "c.db", Store::Mode::create);
        }
    }
    EXPECT_GT(refused, 20);
}

TEST_F(StoreDamage, ADatabaseWithNoiseInIt) {
    int refused = 0;
    for (std::uint64_t trial = 0; trial < 150; ++trial) {
        stats::Generator chance(trial);
        std::string text = database;
        const std::size_t hits = 1 + chance.below(40);
        for (std::size_t hit = 0; hit < hits; ++hit)
            text[chance.below(text.size())] = static_cast<char>(chance.below(256));
        const Folder place;
        write(place / "c.db", text);
        const auto mode = trial % 2 == 0 ? Store::Mode::read : Store::Mode::create;
        refused += ask_everything(whole, place / "c.db", mode) == Finding::refused ? 1 : 0;
    }
    EXPECT_GT(refused, 10);
}

// A log that lost its tail is a log of fewer groups: some prefix of the history, whole in itself.
TEST_F(StoreDamage, ALogCutShortOrZeroedIsAnEarlierLog) {
    ASSERT_GT(log.size(), 30'000u);
    std::int64_t last = -1;
    for (const bool zeros : {false, true}) {
        last = -1;
        for (std::size_t length = 0; length <= log.size(); length += 4099) {
            const Folder place;
            std::string text = log.substr(0, length);
            if (zeros) text.resize(log.size(), '\0');
            write(place / "c.db", unmerged);
            write(place / "c.db-wal", text);
            ASSERT_EQ(complaints(place / "c.db"), "ok") << length;
            const auto completed = completed_in(place / "c.db");
            EXPECT_GE(completed, last) << length;
            last = completed;
        }
        EXPECT_GT(last, 6);
    }
    const Folder place;
    write(place / "c.db", unmerged);
    write(place / "c.db-wal", log.substr(0, log.size() / 2));
    whole.run(place / "c.db", [](std::size_t) {});
    EXPECT_EQ(dump_of(Store(place / "c.db", Store::Mode::read)), whole.undisturbed());
}

}  // namespace grainsweep::tests::store_damage_test
