// The TPMS scene under stress: each setting is answered in finite numbers or reported unstable with what, where and
// when; and as long as it is answered, its early discharge is that of a fine calculation.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "solver/scenes/scene.hpp"
#include "sweep/campaign/installed_machines.hpp"

namespace grainsweep::tests::tpms_corners_test {

const SceneInfo& info() {
    return *campaign::scene_named("tpms_discharge");
}

/// A cell of eight diameters, the column stress of the full one.
Inputs small_cell() {
    Inputs inputs = info().defaults();
    inputs["edge"] = 8.0;
    inputs["shell"] = 2.0;
    inputs["gravity"] = 9.81 * 100 / 8;
    inputs["end_time"] = 1.0;
    return inputs;
}

struct Verdict {
    std::string fault;
    Observations answer;
};

Verdict judge(const Inputs& inputs) {
    NoArtefacts none;
    const auto scene = info().make(inputs, 1, none);
    scene->advance(1e9);
    Verdict verdict{scene->health().reason, {}};
    EXPECT_NE(scene->finished(), !verdict.fault.empty());
    scene->observe(verdict.answer);
    for (const auto& [name, value] : verdict.answer.scalars) EXPECT_FALSE(std::isinf(value)) << name;
    for (const char* name : {"retention", "peak_velocity", "max_overlap", "max_force"})
        EXPECT_TRUE(std::isfinite(verdict.answer.scalars.at(name))) << name;
    for (const auto& x : scene->snapshot().positions)
        for (const double c : x) EXPECT_TRUE(std::isfinite(c));
    return verdict;
}

/// Retention at a time in t*.
double at(const Observations& answer, double t) {
    return std::ranges::lower_bound(answer.series.at("retention_series"), t - 0.009, {}, &Sample::time)->value;
}

class TpmsStress : public testing::TestWithParam<const char*> {
protected:
    [[nodiscard]] static Inputs cell() {
        Inputs inputs = small_cell();
        inputs["precision"] = std::string(GetParam());
        return inputs;
    }
};
INSTANTIATE_TEST_SUITE_P(Both, TpmsStress, testing::Values("mixed", "double"),
                         [](const auto& precision) { return std::string(precision.param); });

TEST_P(TpmsStress, CohesionFarBeyondTheStudyIsAnsweredOrReported) {
    // Two spheres rest at an overlap of (k_c/E*)^2 (3 pi/4)^2 2 d to first order: 17 % of a diameter at 200 kJ/m3,
    // beyond the tenth that the dropped wall presumes.
    for (const double cohesion : {45e3, 80e3, 120e3, 200e3}) {
        Inputs inputs = cell();
        inputs["cohesion"] = cohesion;
        const Verdict verdict = judge(inputs);
        if (cohesion <= 80e3) {
            EXPECT_EQ(verdict.fault, "") << cohesion;
            EXPECT_GT(verdict.answer.scalars.at("retention"), 0.8) << cohesion;
        }
        if (cohesion >= 200e3) {
            EXPECT_NE(verdict.fault, "");
        }
    }
}

TEST_P(TpmsStress, VibrationUpToFiftyTimesGravity) {
    // Gravity here is 12.5 times the standard one, so strengths are up to 625 times that. The strongest at 2 kHz strike
    // at 0.5 m/s, which squeezes so soft a powder by more than the tenth that the dropped wall presumes.
    const double gravity = 9.81 * 100 / 8;
    for (const double frequency : {200.0, 2000.0, 20000.0})
        for (const double strength : {1.0, 4.0, 10.0, 50.0}) {
            Inputs inputs = cell();
            inputs["cohesion"] = 35e3;
            inputs["vibration_frequency"] = frequency;
            const double amplitude = strength * gravity / std::pow(2 * std::numbers::pi * frequency, 2);
            inputs["vibration_amplitude"] = amplitude;
            const Verdict verdict = judge(inputs);
            const double overlap = verdict.answer.scalars.at("max_overlap");
            EXPECT_EQ(verdict.fault.empty(), overlap <= 0.1) << verdict.fault;
            if (2 * std::numbers::pi * frequency * amplitude < 0.3) {
                EXPECT_EQ(verdict.fault, "") << frequency << " Hz, " << strength << " g";
            }
        }
}

TEST_P(TpmsStress, AStepThatIsAnsweredIsRightAndOneThatIsNotIsReported) {
    // 8.0 us is the Rayleigh time. Early on a disturbance has not had the time to grow: the retention at half t* is
    // within the five particles that tell one packing of this size from another.
    Inputs fine = cell();
    fine["time_step"] = 2.5e-7;
    const Verdict reference = judge(fine);
    ASSERT_EQ(reference.fault, "");
    const double particles = reference.answer.scalars.at("particles");
    for (const double step : {5e-7, 1e-6, 2e-6, 4e-6, 7.5e-6}) {
        Inputs inputs = cell();
        inputs["time_step"] = step;
        const Verdict verdict = judge(inputs);
        if (step <= 2e-6) {
            EXPECT_EQ(verdict.fault, "") << step;
        }
        if (verdict.fault.empty()) {
            EXPECT_NEAR(at(verdict.answer, 0.5), at(reference.answer, 0.5), 5 / particles) << step;
        }
    }
}

TEST_P(TpmsStress, AnyLawAnyCellAnyTilt) {
    for (const char* name : {"schwarz_p", "gyroid", "diamond", "iwp", "frd", "i2y"})
        for (const char* law : {"sjkr", "sjkr2", "paper"})
            for (const char* limit : {"contact", "net"}) {
                Inputs inputs = cell();
                inputs["cell"] = std::string(name);
                inputs["shell"] = 1.0;
                inputs["cohesion"] = 20e3;
                inputs["cohesion_law"] = std::string(law);
                inputs["friction_limit"] = std::string(limit);
                inputs["tilt"] = 120.0;
                inputs["tilt_azimuth"] = 30.0;
                inputs["end_time"] = 0.2;
                EXPECT_EQ(judge(inputs).fault, "") << name << " " << law << " " << limit;
            }
}

TEST(TpmsStressOfBothPrecisions, AgreeUntilDisturbancesHaveGrown) {
    Inputs inputs = small_cell();
    inputs["cohesion"] = 25e3;
    inputs["precision"] = std::string("mixed");
    const Verdict mixed = judge(inputs);
    inputs["precision"] = std::string("double");
    const Verdict exact = judge(inputs);
    const double particles = exact.answer.scalars.at("particles");
    for (const double t : {0.1, 0.25, 0.5}) EXPECT_NEAR(at(mixed.answer, t), at(exact.answer, t), 2 / particles) << t;
}

}  // namespace grainsweep::tests::tpms_corners_test
