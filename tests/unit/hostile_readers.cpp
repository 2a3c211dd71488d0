// Bytes from outside, altered at random: every reader understands them or refuses them with a sentence.
#include "solver/particles/packing.hpp"
#include "stats/random.hpp"
#include "sweep/campaign/reader.hpp"
#include "sweep/campaign/wrong_question.hpp"
#include "sweep/workers/message.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::tests {
namespace {

/// Some of: a byte changed, a part cut out or doubled, a word put in that means something to somebody.
std::string altered(std::string text, stats::Generator& chance) {
    constexpr std::array<std::string_view, 16> words = {
        "null", "-1", "1e400", "18446744073709551616", "{}",      "[]",  "\"\"",       "true",
        "\"",   "{",  "]",     "-9223372036854775809", "\\u0000", "NaN", "[[[[[[[[[[", "0.1e-400"};
    for (std::size_t changes = 1 + chance.below(4); changes > 0 && !text.empty(); --changes) {
        const std::size_t at = chance.below(text.size());
        const std::size_t count = 1 + chance.below(std::min<std::size_t>(text.size() - at, 20));
        switch (chance.below(4)) {
            case 0:
                text[at] = static_cast<char>(chance.below(256));
                break;
            case 1:
                text.erase(at, count);
                break;
            case 2:
                text.insert(at, text.substr(at, count));
                break;
            default: {
                const std::string_view word = words.at(chance.below(words.size()));
                const auto end = text.find_first_of(",}]:", at);
                text.replace(at, end == std::string::npos ? count : end - at, word);
            }
        }
    }
    return text;
}

/// Reads every altered text; an exception of another kind goes to the test, a crash ends it.
template <class Refusal, class Reader>
void read_altered(const std::string& sound, std::uint64_t trials, Reader&& reader) {
    int refused = 0;
    for (std::uint64_t trial = 0; trial < trials; ++trial) {
        stats::Generator chance(trial);
        try {
            reader(altered(sound, chance));
        } catch (const Refusal& refusal) {
            EXPECT_GT(std::string_view(refusal.what()).size(), 5u);
            ++refused;
        }
    }
    EXPECT_GT(refused, static_cast<int>(trials / 20));
}

TEST(HostileReaders, MessagesOfAWorker) {
    workers::Done done;
    done.result.attempt = {"0123456789abcdef0123456789abcdef", 3};
    done.result.message = "a sentence";
    done.result.observations.scalars = {{"y", 0.1}, {"z", std::nan("")}};
    done.result.observations.series["y_series"] = {{.time = 0.5, .bin = std::nan(""), .value = 1}, {.time = 1}};
    done.result.cost.phases = {{"contact", 0.25}};
    const auto decode = [](const std::string& line) { (void)workers::decode_to_boss(line); };
    read_altered<std::invalid_argument>(workers::encode(workers::ToBoss(done)), 3000, decode);
    read_altered<std::invalid_argument>(workers::encode(workers::ToBoss(workers::Alive{done.result.attempt, 0.4})),
                                        1000, decode);
}

TEST(HostileReaders, MessagesOfTheBoss) {
    workers::Run run;
    run.question = {"0123456789abcdef0123456789abcdef",
                    "rehearsal",
                    1,
                    {{"x1", 0.5}, {"behave_attempts", std::int64_t{2}}, {"response", std::string("sum")}},
                    7};
    read_altered<std::invalid_argument>(workers::encode(workers::ToWorker(run)), 3000,
                                        [](const std::string& line) { (void)workers::decode_to_worker(line); });
}

TEST(HostileReaders, CampaignFiles) {
    const std::string sound = R"({"campaign": "c", "scene": "powder_spreading", "notes": "text",
        "factors": [{"name": "friction", "between": [0.1, 0.3]}, {"name": "cohesion", "levels": [0, 10000]}],
        "fixed": {"restitution": 0.5, "size_distribution": "lognormal"}, "where": "friction > 0.15",
        "design": {"kind": "halton", "scramble": "random", "sequences": 4, "points": 16}, "replicates": 2, "seed": 3,
        "convergence": {"observable": "mfr", "rule": "replicates", "gates": ["mean"], "tolerance": 0.01, "block": 4},
        "accuracy": "fast", "limits": {"wall_seconds": 60, "attempts": 2},
        "execution": {"workers": 1, "launcher": ["nice"]}})";
    read_altered<campaign::WrongQuestion>(sound, 2000, [](const std::string& text) {
        (void)campaign::parse_campaign(text, std::filesystem::path("/nowhere"));
    });
}

TEST(HostileReaders, PackingsInText) {
    std::string text = "x,y,z\n";
    for (int k = 0; k < 6; ++k) text += std::to_string(0.5 + k) + ",2.5,3.25\n";
    read_altered<std::invalid_argument>(text, 2000,
                                        [](const std::string& csv) { (void)particles::read_packing(csv, 8); });
}

TEST(HostileReaders, PackingsInBytes) {
    particles::Packing packing{8, {{0.5, 1, 2}, {3, 4, 5}, {7, 7, 7}}, 0.01, 5};
    const auto bytes = particles::encode(packing);
    const std::string sound(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    read_altered<std::invalid_argument>(sound, 2000, [](const std::string& text) {
        const auto kept = particles::decode_packing(std::as_bytes(std::span(text)));
        for (const auto& x : kept.positions)
            for (const double c : x) EXPECT_TRUE(c >= 0 && c <= kept.edge);
    });
}

}  // namespace
}  // namespace grainsweep::tests
