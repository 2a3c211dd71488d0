// What text output shows first: main observables in a few words, and commands that can be copied.
#include "sweep/campaign/installed_machines.hpp"
#include "sweep/report/main_observables.hpp"
#include "sweep/report/next_command.hpp"
#include "sweep/report/print_axes.hpp"
#include "tests/support/study.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace grainsweep::tests::report_main_observables_test {

using namespace report;

TEST(MainObservables, OfEverySceneAreFewAndAmongItsScalars) {
    for (const auto& scene : scene_catalogue()) {
        const auto shown = main_observables(scene);
        EXPECT_FALSE(shown.empty()) << scene.name;
        EXPECT_LE(shown.size(), 6U) << scene.name;
        for (const auto& [name, words] : shown) {
            const auto* observable = scene.find_observable(name);
            ASSERT_NE(observable, nullptr) << scene.name << ": " << name;
            EXPECT_EQ(observable->shape, Shape::scalar) << scene.name << ": " << name;
            EXPECT_LE(words.size(), 44U) << scene.name << ": " << name;
        }
    }
}

// A name from a thesis explains nothing to a new reader.
TEST(MainObservables, OfSpreadingBeginWithTheLayer) {
    EXPECT_EQ(main_observables(*campaign::scene_named("powder_spreading")).front().name, "packing_fraction");
}

TEST(MainObservables, AreTheFirstScalarsOfASceneThatNamesNone) {
    SceneInfo scene;
    scene.observables = {{"curve", "1", "a curve", Shape::series}, {"a", "1", "the first: with its definition"}};
    for (const char* name : {"a_error", "b", "c", "d", "e", "f", "g"}) scene.observables.push_back({name, "1", "more"});
    std::string names;
    for (const auto& one : main_observables(scene)) names += one.name;
    EXPECT_EQ(names, "abcdef");
    EXPECT_EQ(main_observables(scene).front().words, "the first");
}

TEST(MainObservables, LongMeaningsEndAtAWord) {
    EXPECT_EQ(in_few_words("short"), "short");
    const std::string cut = in_few_words("one two three four five six seven eight nine ten eleven twelve thirteen");
    EXPECT_EQ(cut, "one two three four five six seven eight ...");
    EXPECT_LE(in_few_words(std::string(200, 'x')).size(), 44U);
}

using MainResponses = Study;

TEST_F(MainResponses, HaveTheObservableThatDecides) {
    answer_by(store, halton("c", 64), [](const Inputs& inputs) { return linear(inputs); });
    const auto shown = main_observables(ask("c"));
    ASSERT_EQ(shown.size(), 1U);
    EXPECT_EQ(shown.front().name, "y");
}

TEST(NextCommand, QuotesWhatAShellWouldSplit) {
    EXPECT_EQ(shell_word("runs/a-1.db"), "runs/a-1.db");
    EXPECT_EQ(shell_word("a first try.db"), "'a first try.db'");
    EXPECT_EQ(shell_word("it's"), "'it'\\''s'");
    EXPECT_EQ(shell_word(""), "''");
    EXPECT_TRUE(next_command("report a.db").ends_with("test_unit report a.db")) << next_command("report a.db");
}

TEST(QuantityText, HasAnEngineersPrefix) {
    EXPECT_EQ(quantity_text(0.0036, "m"), "3.6 mm");
    EXPECT_EQ(quantity_text(-0.00006, "m"), "-60 µm");
    EXPECT_EQ(quantity_text(35'000, "J/m3"), "35 kJ/m³");
    EXPECT_EQ(quantity_text(0.4, "1"), "0.4");
    EXPECT_EQ(quantity_text(0.0000123456, "1"), "1.235e-05");
    EXPECT_EQ(quantity_text(0, "m"), "0 m");
}

}  // namespace grainsweep::tests::report_main_observables_test
