// One flipped bit anywhere in an archive: found, harmless, or asked again. Never a wrong answer.
#include "stats/random.hpp"
#include "sweep/campaign/input_error.hpp"
#include "tests/support/whole_campaign.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <optional>
#include <string>

namespace grainsweep::tests::store_bit_rot_test {

using store::Store;

std::string contents(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// What the question gives; nothing where it is refused with a sentence.
template <class Question>
auto asked(Question&& question) -> std::optional<decltype(question())> {
    try {
        return question();
    } catch (const SystemError&) {
    } catch (const campaign::InputError&) {
    }
    return std::nullopt;
}

struct StoreBitRot : testing::Test {
    static constexpr std::uint64_t flips = 400;
    WholeCampaign whole{60};
    Folder folder;
    std::string sound, expected, values;

    static std::string text_of_values(const Store& store) {
        std::string text;
        for (const auto& value : store.values("misfortune", "y"))
            text += std::to_string(value.point) + ' ' + campaign::shortest(value.value) + '\n';
        return text;
    }

    StoreBitRot() {
        whole.run(folder / "a.db", [](std::size_t) {});
        {
            Store store(folder / "a.db", Store::Mode::create);
            store.enrol(whole.campaign, whole.cases, here());
            store.group([&] {
                for (const std::int64_t points : {8, 16, 24})
                    store.record("misfortune", {"y", points, 1, 0.5, 0, 0, 3, 0.1, 0.2, 0.3, 0.4, 0.5, 0, 0, false});
            });
        }
        sound = contents(folder / "a.db");
        const Store store(folder / "a.db", Store::Mode::read);
        expected = dump_of(store);
        values = text_of_values(store);
    }

    std::filesystem::path flipped(const Folder& place, std::uint64_t trial) const {
        stats::Generator chance(trial);
        std::string text = sound;
        text[chance.below(text.size())] ^= static_cast<char>(1U << chance.below(8));
        const auto file = place / "c.db";
        std::ofstream(file, std::ios::binary) << text;
        return file;
    }
};

TEST_F(StoreBitRot, NoWrongAnswerIsGiven) {
    int found = 0, refused = 0;
    for (std::uint64_t trial = 0; trial < flips; ++trial) {
        const Folder place;
        const auto file = flipped(place, trial);
        const auto dump = asked([&] { return dump_of(Store(file, Store::Mode::read)); });
        const auto damage = asked([&] { return Store(file, Store::Mode::read).verify().size(); });
        EXPECT_EQ(dump.value_or(expected), expected) << "flip " << trial;
        const auto some = asked([&] { return text_of_values(Store(file, Store::Mode::read)); });
        EXPECT_EQ(some.value_or(values), values) << "flip " << trial;
        if (damage && *damage > 0) ++found;
        if (!dump) ++refused;
        EXPECT_TRUE(dump || !damage || *damage > 0) << "refused, and verify finds nothing: flip " << trial;
    }
    RecordProperty("flips", static_cast<int>(flips));
    RecordProperty("found", found);
    RecordProperty("refused", refused);
    EXPECT_GT(found, 50) << "half of the file is empty space";
}

TEST_F(StoreBitRot, TheNextRunPutsItRightOrRefuses) {
    int right = 0;
    for (std::uint64_t trial = 0; trial < flips / 4; ++trial) {
        const Folder place;
        const auto file = flipped(place, trial);
        const auto ran = asked([&] {
            whole.run(file, [](std::size_t) {});
            return true;
        });
        if (!ran) continue;
        const auto dump = asked([&] { return dump_of(Store(file, Store::Mode::read)); });
        if (!dump) continue;
        ++right;
        // Verdicts that were damaged are the scheduler's to give anew: they may be missing here.
        const auto cases = [](const std::string& text) { return text.substr(0, text.find("  convergence")); };
        EXPECT_EQ(cases(*dump), cases(expected)) << "flip " << trial;
    }
    EXPECT_GT(right, 30);
}

}  // namespace grainsweep::tests::store_bit_rot_test
