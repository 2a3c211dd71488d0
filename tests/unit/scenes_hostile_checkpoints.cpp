// A checkpoint may hold any bytes, resealed or not: every scene restores it or refuses it with a sentence, and what it
// restored can be continued, to an answer or to a fault. Run under the address sanitizer, this finds what reads or
// writes beside its memory.
#include "solver/scenes/scene.hpp"
#include "stats/random.hpp"
#include "sweep/campaign/installed_machines.hpp"
#include "tests/support/machines.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace grainsweep::tests::scenes_hostile_checkpoints_test {

struct Hostile {
    std::string scene;
    Inputs inputs;
    double from = 0;  ///< time of the checkpoint, s or of the scene
    std::string name;
};

/// Keeps what it is given, so that a packing is made once.
class Kept final : public Artefacts {
public:
    [[nodiscard]] std::optional<Bytes> get(std::string_view key) override {
        const auto found = kept_.find(std::string(key));
        return found == kept_.end() ? std::nullopt : std::optional(found->second);
    }
    void put(std::string_view key, std::span<const std::byte> contents) override {
        kept_[std::string(key)].assign(contents.begin(), contents.end());
    }

private:
    std::map<std::string, Bytes> kept_;
};

Inputs with(const SceneInfo& scene, const Inputs& chosen) {
    Inputs inputs = scene.defaults();
    for (const auto& [name, value] : chosen) inputs[name] = value;
    return inputs;
}

std::unique_ptr<Scene> made(const SceneInfo& scene, const Inputs& inputs, Artefacts& artefacts) {
    return scene.make(inputs, 7, artefacts, {});
}

/// One change: a bit, a whole number or a real where one may stand, a part cut out or put in, the end cut off.
void alter(Bytes& bytes, stats::Generator& chance) {
    const std::size_t at = chance.below(bytes.size());
    const auto put = [&](const auto& value) {
        const std::size_t place = bytes.size() > sizeof value ? at / 4 * 4 % (bytes.size() - sizeof value) : 0;
        if (bytes.size() >= sizeof value) std::memcpy(bytes.data() + place, &value, sizeof value);
    };
    constexpr std::array<std::int64_t, 6> wholes = {
        -1, 0, 1, 1 << 20, std::numeric_limits<std::int32_t>::max(), std::numeric_limits<std::int64_t>::min()};
    constexpr std::array<double, 5> reals = {std::numeric_limits<double>::quiet_NaN(),
                                             std::numeric_limits<double>::infinity(), -1e300, 1e10, 0};
    switch (chance.below(7)) {
        case 0:
            bytes[at] ^= static_cast<std::byte>(1U << chance.below(8));
            return;
        case 1:
            return put(wholes.at(chance.below(wholes.size())));
        case 2:
            return put(static_cast<std::int32_t>(wholes.at(chance.below(wholes.size()))));
        case 3:
            return put(reals.at(chance.below(reals.size())));
        case 4:
            return put(static_cast<float>(reals.at(chance.below(reals.size()))));
        case 5:
            bytes[at] = static_cast<std::byte>(chance.below(256));
            return;
        default:
            break;
    }
    const std::size_t count = 1 + chance.below(std::min<std::size_t>(bytes.size(), 64));
    const auto place = bytes.begin() + static_cast<std::ptrdiff_t>(at);
    switch (chance.below(3)) {
        case 0:
            bytes.resize(bytes.size() - count);
            return;
        case 1:
            bytes.insert(place, count, static_cast<std::byte>(chance.below(256)));
            return;
        default:
            bytes.erase(place, place + static_cast<std::ptrdiff_t>(std::min(count, bytes.size() - at)));
    }
}

class HostileCheckpoints : public testing::TestWithParam<Hostile> {};

TEST_P(HostileCheckpoints, AreRestoredOrRefused) {
    const auto& kind = GetParam();
    const SceneInfo& scene = *campaign::scene_named(kind.scene);
    const Inputs inputs = with(scene, kind.inputs);
    Kept artefacts;
    Bytes sound;
    double slice = 0;
    {
        const auto calm = made(scene, inputs, artefacts);
        calm->advance(kind.from);
        ASSERT_FALSE(calm->finished());
        ASSERT_TRUE(calm->health().stable()) << calm->health().reason;
        calm->save(sound);
        const double before = calm->time();
        calm->advance(before * (1 + 1e-12));  // one step
        slice = calm->time() - before;
    }
    int restored = 0, refused = 0;
    constexpr std::uint64_t trials = 100;
    for (std::uint64_t trial = 0; trial < trials; ++trial) {
        stats::Generator chance(trial);
        Bytes bytes = sound;
        // The first bytes say what the others are.
        if (trial % 3 == 0) {
            Bytes head(bytes.begin(),
                       bytes.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(512, bytes.size())));
            alter(head, chance);
            bytes.erase(bytes.begin(),
                        bytes.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(512, bytes.size())));
            bytes.insert(bytes.begin(), head.begin(), head.end());
        }
        for (std::size_t changes = trial % 3 == 0 ? 0 : 1 + chance.below(4); changes > 0 && !bytes.empty(); --changes)
            alter(bytes, chance);
        const auto one = made(scene, inputs, artefacts);
        try {
            one->restore(bytes);
        } catch (const std::invalid_argument& error) {
            EXPECT_GT(std::string(error.what()).size(), 10u);
            ++refused;
            continue;
        }
        ++restored;
        for (int k = 0; k < 3 && !one->finished() && one->health().stable(); ++k) one->advance(one->time() + 4 * slice);
        Observations seen;
        if (one->health().stable()) one->observe(seen);
        (void)one->progress();
        (void)one->snapshot();
        Bytes again;
        one->save(again);
    }
    EXPECT_GT(refused, 5);
    EXPECT_EQ(restored + refused, static_cast<int>(trials));
}

std::vector<Hostile> kinds() {
    const Value mixed = std::string("mixed"), in_double = std::string("double");
    const auto thermo = [](const char* coupling) {
        return Inputs{{"coupling", std::string(coupling)}, {"cells", std::int64_t{8}}, {"particles", std::int64_t{64}}};
    };
    static const std::string bin = campaign::enter_machine(machine_of(small_machine()))->name;
    std::vector<Hostile> all = {
        {bin, {{"precision", mixed}}, 0.055, "MachineMixed"},
        {bin, {{"precision", in_double}}, 0.055, "MachineDouble"},
        {"rehearsal", {{"wait_seconds", 0.05}}, 0.01, "Rehearsal"},
        {"tpms_discharge", {{"edge", 12.0}, {"precision", mixed}}, 0.004, "TpmsMixed"},
        {"tpms_discharge", {{"edge", 12.0}, {"precision", in_double}}, 0.004, "TpmsDouble"},
        {"powder_spreading", {{"precision", mixed}}, 0.02, "SpreadingMixed"},
        {"powder_spreading", {{"precision", in_double}}, 0.02, "SpreadingDouble"},
        {"powder_spreading",
         {{"precision", in_double}, {"size_distribution", std::string("lognormal")}},
         0.02,
         "SpreadingSizes"},
        {"powder_spreading",
         {{"diameter", 0.004},
          {"gap", 0.01},
          {"width", 3.0},
          {"travel", 0.05},
          {"layer_area", 3e-4},
          {"settle_time", 0.01},
          {"base", std::string("rough")},
          {"layers", std::int64_t{2}}},
         0.055,
         "SpreadingSecondLayer"},
        {"rotating_drum",
         {{"precision", in_double}, {"particles", std::int64_t{100}}, {"turning_time", 0.01}},
         0.02,
         "DrumDouble"},
        {"hopper",
         {{"precision", mixed},
          {"particles", std::int64_t{100}},
          {"container_diameter", 0.04},
          {"opening_size", 0.02},
          {"settle_time", 0.05}},
         0.1,
         "Hopper"},
        {"heap",
         {{"precision", mixed}, {"particles", std::int64_t{60}}, {"tube_diameter", 0.03}, {"settle_time", 0.05}},
         0.1,
         "Heap"},
        {"rotating_drum",
         {{"precision", mixed}, {"particles", std::int64_t{100}}, {"turning_time", 0.01}},
         0.02,
         "DrumMixed"},
        {"thermovibration", thermo("one_way"), 0.002, "OneWay"},
        {"thermovibration", thermo("two_way"), 0.002, "TwoWay"},
        {"thermovibration", thermo("ddpm"), 0.002, "Ddpm"},
        {"thermovibration", thermo("ddpm_ktgf"), 0.002, "DdpmKtgf"},
        {"thermovibration", thermo("cfd_dem"), 0.002, "CfdDem"},
    };
    return all;
}

INSTANTIATE_TEST_SUITE_P(Scenes, HostileCheckpoints, testing::ValuesIn(kinds()),
                         [](const auto& kind) { return kind.param.name; });

}  // namespace grainsweep::tests::scenes_hostile_checkpoints_test
