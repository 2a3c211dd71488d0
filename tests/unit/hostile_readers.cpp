// Bytes from outside, altered at random: every reader understands them or refuses them with a sentence.
#include "solver/geometry/mesh.hpp"
#include "solver/geometry/stl.hpp"
#include "solver/particles/packing.hpp"
#include "stats/random.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/reader.hpp"
#include "sweep/workers/message.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::tests::hostile_readers_test {

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
    read_altered<campaign::InputError>(sound, 2000, [](const std::string& text) {
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

/// Triangles at random, among them slivers, needles, repeated ones and those of no area.
std::vector<std::array<geometry::Vec3, 3>> random_triangles(stats::Generator& chance) {
    constexpr std::array<double, 8> coordinates = {0, 1, -1, 0.5, 1e-9, 1e-40, 3, 0.3333333333333333};
    std::vector<std::array<geometry::Vec3, 3>> triangles(1 + chance.below(12));
    for (auto& triangle : triangles)
        for (auto& corner : triangle)
            for (double& x : corner)
                x = chance.below(3) == 0 ? 1e-3 * static_cast<double>(chance.below(1000))
                                         : coordinates.at(chance.below(coordinates.size()));
    return triangles;
}

template <class T>
void append(std::string& bytes, const T& value) {
    const std::size_t at = bytes.size();
    bytes.resize(at + sizeof value);
    std::memcpy(bytes.data() + at, &value, sizeof value);
}

/// Numbers that are none, that are at the ends of what a float holds, and where a coordinate is too far.
float strange(stats::Generator& chance) {
    using Limits = std::numeric_limits<float>;
    constexpr std::array<float, 8> values = {Limits::quiet_NaN(),
                                             Limits::infinity(),
                                             -Limits::infinity(),
                                             Limits::max(),
                                             Limits::min(),
                                             Limits::denorm_min(),
                                             1e9F,
                                             -0.0F};
    return values.at(chance.below(values.size()));
}

/// A binary file whose header, count, numbers and length may be wrong.
std::string binary_stl(stats::Generator& chance) {
    const auto triangles = random_triangles(chance);
    std::string bytes = chance.below(3) == 0 ? "solid of a kind" : "";
    bytes.resize(80, chance.below(2) == 0 ? ' ' : '\0');
    auto count = static_cast<std::uint32_t>(triangles.size());
    constexpr std::array<std::uint32_t, 4> counts = {0, 0xFFFFFFFF, 0x80000000, 85899346};  // 50 n beyond 32 bits
    if (chance.below(8) == 0) count = counts.at(chance.below(counts.size()));
    append(bytes, count);
    for (const auto& triangle : triangles) {
        for (int k = 0; k < 3; ++k) append(bytes, strange(chance));
        for (const auto& corner : triangle)
            for (const double x : corner)
                append(bytes, chance.below(60) == 0 ? strange(chance) : static_cast<float>(x));
        append(bytes, static_cast<std::uint16_t>(chance.below(65536)));
    }
    if (chance.below(8) == 0) bytes.resize(chance.below(bytes.size() + 50));
    return bytes;
}

/// A text whose words and numbers may be wrong.
std::string text_stl(stats::Generator& chance) {
    constexpr std::array<std::string_view, 14> numbers = {"nan", "-inf", "1e999", "1e-999",    "0x1p3", "1,5", "",
                                                          "--1", "1e",   "+",     "123456789", ".5",    "5.",  "1e8"};
    constexpr std::array<std::string_view, 6> blanks = {" ", "\t", "\r\n", "\n", "  ", "\v"};
    std::string text = chance.below(10) == 0 ? "\xEF\xBB\xBF" : "";
    const auto word = [&](std::string_view known) {
        if (chance.below(300) != 0) text += known;
        text += blanks.at(chance.below(blanks.size()));
    };
    for (std::size_t solids = 1 + chance.below(3); solids > 0; --solids) {
        text += "solid name\n";
        for (const auto& triangle : random_triangles(chance)) {
            for (const auto* known : {"facet", "normal", "0", "nan", "1", "outer", "loop"}) word(known);
            for (const auto& corner : triangle) {
                word("vertex");
                for (const double x : corner)
                    word(chance.below(100) == 0 ? std::string(numbers.at(chance.below(numbers.size())))
                                                : std::to_string(x));
            }
            for (const auto* known : {"endloop", "endfacet"}) word(known);
        }
        text += "endsolid name\n";
    }
    return text;
}

/// What was read is a surface, and a wall that a sphere touches in places that are numbers.
void require_surface(const geometry::StlSurface& read) {
    ASSERT_FALSE(read.surface.triangles.empty());
    for (const auto& triangle : read.surface.triangles)
        for (const std::int32_t corner : triangle)
            ASSERT_TRUE(corner >= 0 && static_cast<std::size_t>(corner) < read.surface.corners.size());
    using namespace geometry;
    const Mesh mesh(read.surface);
    const geometry::Vec3 middle = 0.5 * (mesh.low() + mesh.high());
    const double extent = geometry::norm(mesh.high() - mesh.low());
    for (const geometry::Vec3& x : {middle, mesh.low(), mesh.high() + geometry::Vec3{0, 0, 0.1 * extent}}) {
        std::vector<geometry::MeshContact> found;
        mesh.contacts(x, extent, found);
        for (const auto& contact : found) {
            ASSERT_TRUE(contact.distance >= 0 && contact.distance < extent);
            ASSERT_NEAR(geometry::norm(contact.normal), 1, 1e-6);
        }
    }
}

TEST(HostileReaders, StlFiles) {
    int read = 0, refused = 0;
    for (std::uint64_t trial = 0; trial < 20000; ++trial) {
        stats::Generator chance(trial);
        std::string contents = trial % 2 == 0 ? binary_stl(chance) : text_stl(chance);
        if (chance.below(5) == 0) contents = altered(contents, chance);
        const double scale = std::array{1.0, 1e-3, 1e3, 1e-9}.at(chance.below(4));
        try {
            require_surface(geometry::read_stl(contents, scale));
            if (testing::Test::HasFatalFailure()) {
                ADD_FAILURE() << "trial " << trial;
                return;
            }
            ++read;
        } catch (const std::invalid_argument& refusal) {
            EXPECT_TRUE(std::string_view(refusal.what()).starts_with("STL: ")) << trial << ": " << refusal.what();
            ++refused;
        }
    }
    EXPECT_GT(read, 5000);
    EXPECT_GT(refused, 3000);
}

}  // namespace grainsweep::tests::hostile_readers_test
