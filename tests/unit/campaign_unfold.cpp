// From a campaign to its cases: values of factors, identity, seeds, numbering.
#include "sweep/campaign/campaign.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/reader.hpp"
#include "sweep/campaign/relevance.hpp"
#include "sweep/files/whole_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>

namespace grainsweep::tests::campaign_unfold_test {

using namespace campaign;

const SceneInfo& rehearsal() {
    return *find_scene("rehearsal");
}

Campaign read(const std::string& text, const std::filesystem::path& folder = ".") {
    return parse_campaign(text, folder);
}

ParameterSpace space_of(std::vector<Factor> factors) {
    return {unowned(rehearsal()), std::move(factors), {}};
}

double x1_at(const Between& range, double u) {
    const std::array point = {u};
    return std::get<double>(space_of({{"x1", range}}).at(point).at("x1"));
}

const std::string three_by_two = R"({
  "campaign": "trial", "scene": "rehearsal", "seed": 5, "replicates": 2,
  "factors": [{"name": "x1", "between": [0, 1]}, {"name": "response", "levels": ["sum", "ishigami"]}],
  "fixed": {"x3": 0.25},
  "design": {"kind": "lattice", "levels": 3}
})";

TEST(ParameterSpace, LinearMapIsLowPlusUTimesRange) {
    for (const double u : {0.0, 0.1, 1.0 / 3, 0.7, 1.0}) {
        EXPECT_EQ(x1_at({0.1, 0.3, Scale::linear}, u), 0.1 + u * (0.3 - 0.1)) << u;
    }
}

TEST(ParameterSpace, LogarithmicMapHitsTheGeometricMean) {
    EXPECT_EQ(x1_at({0.001, 0.1, Scale::log}, 0), 0.001);
    EXPECT_NEAR(x1_at({0.001, 0.1, Scale::log}, 0.5), 0.01, 1e-17);
    EXPECT_NEAR(x1_at({0.001, 0.1, Scale::log}, 1), 0.1, 1e-16);
}

TEST(ParameterSpace, LevelIsTheFloorOfKTimesU) {
    const auto space = space_of({{"response", Levels{{"sum", "ishigami", "g_function"}}}});
    const auto word = [&](double u) {
        const std::array point = {u};
        return std::get<std::string>(space.at(point).at("response"));
    };
    EXPECT_EQ(word(0), "sum");
    EXPECT_EQ(word(std::nextafter(1.0 / 3, 0)), "sum");
    EXPECT_EQ(word(0.34), "ishigami");
    EXPECT_EQ(word(std::nextafter(1.0, 0)), "g_function");
    EXPECT_EQ(word(1), "g_function");
}

TEST(ParameterSpace, ValuesTakeTheDeclaredTypeAndZeroHasNoSign) {
    const auto space =
        space_of({{"x1", Levels{{-0.0}}}, {"x2", Levels{{std::int64_t{1}}}}, {"behave_attempts", Levels{{2.0}}}});
    const std::array row = {Value{-0.0}, Value{std::int64_t{1}}, Value{2.0}};
    const auto inputs = space.at(std::span<const Value>(row));
    EXPECT_FALSE(std::signbit(std::get<double>(inputs.at("x1"))));
    EXPECT_EQ(inputs.at("x2"), Value{1.0});
    EXPECT_EQ(inputs.at("behave_attempts"), Value{std::int64_t{2}});
    EXPECT_EQ(inputs.size(), rehearsal().parameters.size());
}

TEST(Identity, IsTheHashOfWhatIsAskedAndDiffersFromTheDefaults) {
    // The law: scene, revision, what differs from the defaults (sorted), seed, one a line.
    const auto id = [](const Inputs& inputs, std::uint64_t seed) { return make_case(rehearsal(), inputs, seed).id; };
    EXPECT_EQ(id({}, 7), content_hash("scene=rehearsal\nrevision=1\nseed=7\n"));
    EXPECT_EQ(id({{"x2", 0.1}, {"x1", 0.25}, {"x3", 0.5}}, 7),
              content_hash("scene=rehearsal\nrevision=1\nx1=0.25\nx2=0.1\nseed=7\n"));
    EXPECT_EQ(id({{"response", std::string("ishigami")}, {"behave_attempts", 3.0}, {"noise", -0.0}}, 0),
              content_hash("scene=rehearsal\nrevision=1\nbehave_attempts=3\nresponse=ishigami\nseed=0\n"));
    // And remembered, so that an archive of today is understood tomorrow.
    EXPECT_EQ(id({}, 7), "fd100a677d925c95b681565e45b21cba");
    EXPECT_EQ(id({{"x2", 0.1}, {"x1", 0.25}, {"x3", 0.5}}, 7), "feb05b9ab2919ab53a94e9468db8e1c3");
    EXPECT_EQ(id({{"response", std::string("ishigami")}, {"behave_attempts", 3.0}, {"noise", -0.0}}, 0),
              "152a29e70b6ca436cab0cb52758fd5b4");
}

TEST(Identity, AnUnknownParameterIsRefused) {
    EXPECT_THROW((void)make_case(rehearsal(), {{"x17", 0.5}}, 1), InputError);
}

TEST(Unfold, NumbersPointsThenReplicatesWithTheLastFactorFastest) {
    const auto cases = unfold(read(three_by_two), {});
    ASSERT_EQ(cases.size(), 12U);
    for (std::size_t k = 0; k < cases.size(); ++k) {
        EXPECT_EQ(cases[k].point, static_cast<std::int64_t>(k / 2));
        EXPECT_EQ(cases[k].replicate, static_cast<std::int64_t>(k % 2));
        EXPECT_EQ(cases[k].question.inputs.at("x1"), Value{0.5 * static_cast<double>(k / 4)});
        EXPECT_EQ(cases[k].question.inputs.at("response"), Value{std::string((k / 2) % 2 == 0 ? "sum" : "ishigami")});
        EXPECT_EQ(cases[k].question.inputs.at("x3"), Value{0.25});
    }
}

TEST(Unfold, SeedsFollowFromWhatIsAskedAlone) {
    const auto cases = unfold(read(three_by_two), {});
    std::set<std::uint64_t> seeds;
    for (const auto& placed : cases) {
        const std::string asked =
            canonical_text("rehearsal", 1, placed.question.inputs, rehearsal().defaults(), std::nullopt);
        EXPECT_EQ(placed.question.seed, case_seed(5, asked, placed.replicate));
        EXPECT_LT(placed.question.seed, 1ULL << 63U);
        EXPECT_EQ(placed.question, make_case(rehearsal(), placed.question.inputs, placed.question.seed));
        seeds.insert(placed.question.seed);
    }
    EXPECT_EQ(seeds.size(), cases.size());

    // The same question at another place of another campaign is the same case.
    const auto other = unfold(read(R"({"campaign": "other", "scene": "rehearsal", "seed": 5,
        "factors": [{"name": "x3", "levels": [0, 0.25]}, {"name": "x1", "levels": [1, 0.5]}],
        "design": {"kind": "list", "rows": [[0, 1], [0.25, 0.5]]}})"),
                              {});
    EXPECT_EQ(other[1].question, cases[4].question);
    EXPECT_EQ(other[1].point, 1);
}

TEST(Unfold, FilteredPointsLeaveGapsInTheNumbers) {
    const auto campaign = read(three_by_two);
    const auto kept = unfold(campaign, [](const Inputs& inputs) { return std::get<double>(inputs.at("x1")) != 0.5; });
    const auto all = unfold(campaign, {});
    ASSERT_EQ(kept.size(), 8U);
    EXPECT_EQ(kept[4].point, 4);
    EXPECT_EQ(kept[4].question, all[8].question);
    EXPECT_THROW((void)unfold(campaign, [](const Inputs&) { return false; }), InputError);
}

TEST(Unfold, ACaseIsMadeWhenItIsAskedForAndFoundByItsId) {
    const auto cases = unfold(read(three_by_two), {});
    Case reused;
    Inputs inputs;
    for (std::size_t k = cases.size(); k-- > 0;) {
        cases.question(k, reused);
        EXPECT_EQ(reused, cases[k].question) << "what an earlier case left changes nothing";
        cases.inputs(k, inputs);
        EXPECT_EQ(inputs, reused.inputs);
        EXPECT_EQ(cases.id(k), reused.id);
        EXPECT_EQ(id_of(hash_of(reused.id)), reused.id);
        EXPECT_EQ(cases.find(hash_of(reused.id)), k);
        EXPECT_TRUE(cases.is_first(k));
    }
    EXPECT_FALSE(cases.find(hash_of("none of them")));
}

TEST(Unfold, AQuestionThatStandsSeveralTimesIsFoundAtAllItsPlaces) {
    const auto cases = unfold(read(R"({"campaign": "trial", "scene": "rehearsal",
        "factors": [{"name": "x1", "levels": [0, 1]}],
        "design": {"kind": "list", "rows": [[0], [1], [0], [0], [1]]}})"),
                              {});
    EXPECT_EQ(cases.find(cases.hash(3)), 0U);
    EXPECT_EQ(cases.next(0), 2U);
    EXPECT_EQ(cases.next(2), 3U);
    EXPECT_FALSE(cases.next(3));
    EXPECT_EQ(cases.next(1), 4U);
    EXPECT_EQ(cases.first(4), 1U);
    EXPECT_FALSE(cases.is_first(4));
}

TEST(Unfold, MorePointsAndReplicatesExtend) {
    const auto text = [](const char* points, const char* replicates) {
        return std::string(
                   R"({"campaign": "trial", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]}],
            "design": {"kind": "halton", "sequences": 4, "points": )") +
               points + R"(}, "replicates": )" + replicates + "}";
    };
    const auto few = unfold(read(text("8", "1")), {});
    const auto more = unfold(read(text("24", "2")), {});
    for (std::size_t k = 0; k < few.size(); ++k) {
        EXPECT_EQ(few[k].question, more[2 * k].question);
        EXPECT_EQ(few[k].point, more[2 * k].point);
        EXPECT_EQ(few[k].sequence, static_cast<std::int64_t>(k % 4));
    }
}

TEST(Unfold, ImpossibleDesignsAreRefused) {
    EXPECT_THROW((void)unfold(read(R"({"campaign": "trial", "scene": "rehearsal",
        "factors": [{"name": "x1", "between": [0, 1]}],
        "design": {"kind": "halton", "points": 8, "sequences": 2, "scramble": "none"}})"),
                              {}),
                 InputError);
    EXPECT_THROW((void)unfold(read(R"({"campaign": "trial", "scene": "rehearsal", "replicates": 1000000,
        "factors": [{"name": "x1", "between": [0, 1]}], "design": {"kind": "halton", "points": 11}})"),
                              {}),
                 InputError);
}

TEST(ListedRows, FromAFileAreThoseWrittenIn) {
    const auto folder = std::filesystem::temp_directory_path() / "grainsweep_rows";
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "rows.csv") << "\xEF\xBB\xBFresponse, x1\r\n\"sum\",0.25\r\nishigami,1\r\n\r\n";
    const auto text = [](const char* source) {
        return std::string(R"({"campaign": "trial", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]},
            {"name": "response", "levels": ["sum", "ishigami"]}], "design": {"kind": "list", )") +
               source + "}}";
    };
    const auto filed = unfold(read(text(R"("file": "rows.csv")"), folder), {});
    const auto written = unfold(read(text(R"("rows": [[0.25, "sum"], [1, "ishigami"]])")), {});
    ASSERT_EQ(filed.size(), 2U);
    for (std::size_t k = 0; k < 2; ++k) EXPECT_EQ(filed[k].question, written[k].question);

    const auto sentence = [&](const char* contents) -> std::string {
        std::ofstream(folder / "rows.csv") << contents;
        try {
            (void)read(text(R"("file": "rows.csv")"), folder);
        } catch (const InputError& wrong) {
            return wrong.what();
        }
        return "no complaint";
    };
    EXPECT_EQ(sentence("x1,respons\n0,sum\n"),
              "$.design.file: got \"rows.csv\"; column 2 of its header, \"respons\", is no factor of the campaign. Did "
              "you mean 'response'?");
    EXPECT_EQ(sentence("x1\n0\n"), "$.design.file: got \"rows.csv\"; its header has no column for factor 'response'.");
    EXPECT_EQ(sentence("x1,response\n0\n"), "$.design.file: got \"rows.csv\"; record 2 has 1 cells and the header 2.");
    EXPECT_EQ(
        sentence("x1,response\n0,sum\n1e,sum\n"),
        "$.design.file: rows.csv, record 3, column 'x1': got \"1e\"; 'x1' must be a number from 0 to 1: 'e' does not "
        "fit '1', these fit: %.");
    EXPECT_EQ(sentence("x1,response\n0,g_function\n"),
              "$.design.file: rows.csv, record 2, column 'response': got \"g_function\"; is none of the levels of "
              "factor 'response'.");
    EXPECT_EQ(sentence("x1,response\n"), "$.design.file: got \"rows.csv\"; it has no row below its header.");
    std::filesystem::remove_all(folder);
}

// A disk that fails in the middle must not pass for the end of a shorter list.
TEST(ListedRows, OfAFileThatCannotBeReadToItsEndAreRefused) {
    const auto folder = std::filesystem::temp_directory_path() / "grainsweep_rows_of_a_failing_disk";
    std::filesystem::create_directories(folder);
    std::filesystem::remove(folder / "rows.csv");
    std::filesystem::create_symlink("/proc/self/mem", folder / "rows.csv");
    try {
        (void)read(R"({"campaign": "trial", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]}],
            "design": {"kind": "list", "file": "rows.csv"}})",
                   folder);
        ADD_FAILURE() << "a file that cannot be read was read";
    } catch (const InputError& wrong) {
        EXPECT_NE(std::string(wrong.what()).find("rows.csv; the file cannot be read: Input/output error"),
                  std::string::npos)
            << wrong.what();
    }
    std::filesystem::remove_all(folder);
}

TEST(FileWords, AreIdentifiedByTheirContents) {
    const auto folder = std::filesystem::temp_directory_path() / "grainsweep_file_words";
    std::filesystem::create_directories(folder / "elsewhere");
    std::ofstream(folder / "packing.csv") << "x,y,z\n0,0,0\n";
    std::ofstream(folder / "elsewhere" / "same.csv") << "x,y,z\n0,0,0\n";
    std::ofstream(folder / "other.csv") << "x,y,z\n0,0,1\n";
    const ParameterSpec packing{
        "packing", "", "where the particles are", std::string("generated"), Words{{"generated"}, true}, {}};
    const auto word = [&](const char* name) { return parse_value(packing, name, folder, "--set packing"); };
    EXPECT_EQ(word("generated"), Value{std::string("generated")});
    const std::string filed = std::get<std::string>(word("packing.csv"));
    const auto parts = file_word(filed);
    ASSERT_TRUE(parts.has_value());
    EXPECT_EQ(parts->hash, content_hash("x,y,z\n0,0,0\n"));
    EXPECT_EQ(parts->path, std::filesystem::canonical(folder / "packing.csv").string());
    EXPECT_EQ(identity_text(word("packing.csv")), identity_text(word("elsewhere/same.csv")));
    EXPECT_NE(identity_text(word("packing.csv")), identity_text(word("other.csv")));
    try {
        (void)word("pakcing.csv");
        FAIL() << "it was read";
    } catch (const InputError& wrong) {
        EXPECT_STREQ(wrong.what(),
                     "--set packing: got \"pakcing.csv\"; must be 'generated' or a file beside the campaign file, and "
                     "there is no such file. Did you mean 'packing.csv'?");
    }
    std::filesystem::remove(folder / "packing.csv");
    std::filesystem::create_symlink("/proc/self/mem", folder / "packing.csv");  // as a disk that fails
    try {
        (void)word("packing.csv");
        FAIL() << "it was read";
    } catch (const InputError& wrong) {
        EXPECT_STREQ(wrong.what(), "--set packing: got \"packing.csv\"; the file cannot be read: Input/output error.");
    }
    std::filesystem::remove_all(folder);
}

TEST(WholeFile, HoldsEveryByteOrSaysWhyNot) {
    const auto folder = std::filesystem::temp_directory_path() / "grainsweep_whole_file";
    std::filesystem::create_directories(folder);
    std::string bytes;
    for (int k = 0; k < 200'000; ++k) bytes += static_cast<char>(k * 31 / 7);
    std::ofstream(folder / "bytes", std::ios::binary) << bytes;
    std::ofstream(folder / "nothing");
    std::error_code error = std::make_error_code(std::errc::interrupted);
    EXPECT_EQ(files::whole_file(folder / "bytes", error), bytes);
    EXPECT_FALSE(error);
    EXPECT_EQ(files::whole_file(folder / "bytes", error, bytes.size()), bytes);
    EXPECT_FALSE(error);
    EXPECT_EQ(files::whole_file(folder / "nothing", error), "");
    EXPECT_FALSE(error);
    (void)files::whole_file(folder / "bytes", error, bytes.size() - 1);
    EXPECT_EQ(error, std::errc::file_too_large);
    EXPECT_EQ(files::whole_file(folder, error), "");
    EXPECT_EQ(error, std::errc::is_a_directory);
    EXPECT_EQ(files::whole_file(folder / "none", error), "");
    EXPECT_EQ(error, std::errc::no_such_file_or_directory);
    EXPECT_EQ(files::whole_file("/proc/self/mem", error), "");
    EXPECT_EQ(error, std::errc::io_error);
    std::filesystem::remove_all(folder);
}

/// A scene with parameters that depend on each other, as the blade's do.
SceneInfo dependent_scene() {
    SceneInfo scene;
    scene.name = "dependent";
    const Interval any{};
    const auto real = [&](const char* name, double value, std::vector<Relevance> relevant_if) {
        scene.parameters.push_back({name, "1", "", value, any, std::move(relevant_if)});
    };
    real("amplitude", 0, {});
    real("frequency", 50, {{"amplitude", Relevance::Condition::nonzero, {}}});
    real("time_step", 0, {});
    real("fraction", 0.2, {{"time_step", Relevance::Condition::zero, {}}});
    scene.parameters.push_back({"law", "", "", std::string("a"), Words{{"a", "b", "c"}}, {}});
    real("strength", 1, {{"law", Relevance::Condition::is_word, {"b", "c"}}});
    scene.accuracy = {{"fast", {{"fraction", 0.4}, {"strength", 2.0}}}};
    return scene;
}

TEST(Relevance, AFactorSatisfiesAConditionIfAnyOfItsValuesCan) {
    const SceneInfo scene = dependent_scene();
    const auto reason = [&](const char* parameter, std::vector<Factor> factors, Inputs fixed) {
        const ParameterSpace space{unowned(scene), std::move(factors), std::move(fixed)};
        return no_effect(space, *scene.find_parameter(parameter)).value_or("it matters");
    };
    EXPECT_EQ(
        reason("frequency", {}, {}),
        "'frequency' has no effect here: it matters only where 'amplitude' is not zero, and that is 0 by default");
    EXPECT_EQ(reason("frequency", {}, {{"amplitude", 0.0}}),
              "'frequency' has no effect here: it matters only where 'amplitude' is not zero, and that is 0");
    EXPECT_EQ(reason("frequency", {}, {{"amplitude", 1e-5}}), "it matters");
    EXPECT_EQ(reason("frequency", {{"amplitude", Between{0, 1}}}, {}), "it matters");
    EXPECT_EQ(reason("frequency", {{"amplitude", Levels{{0.0, 1.0}}}}, {}), "it matters");
    EXPECT_EQ(reason("frequency", {{"amplitude", Levels{{0.0}}}}, {}),
              "'frequency' has no effect here: it matters only where 'amplitude' is not zero, which this factor never "
              "is");
    EXPECT_EQ(reason("fraction", {}, {}), "it matters");
    EXPECT_EQ(reason("fraction", {{"time_step", Between{1e-6, 1e-5}}}, {}),
              "'fraction' has no effect here: it matters only where 'time_step' is zero, which this factor never is");
    EXPECT_EQ(reason("fraction", {{"time_step", Between{0, 1e-5}}}, {}), "it matters");
    EXPECT_EQ(reason("strength", {}, {}),
              "'strength' has no effect here: it matters only where 'law' is 'b' or 'c', and that is a by default");
    EXPECT_EQ(reason("strength", {{"law", Levels{{std::string("a"), std::string("c")}}}}, {}), "it matters");
}

TEST(Accuracy, FillsInUnderWhatIsGivenAndOnlyWhatMatters) {
    const SceneInfo scene = dependent_scene();
    const auto resolved = [&](Inputs fixed) {
        ParameterSpace space{unowned(scene), {}, std::move(fixed)};
        resolve_accuracy(space, "fast");
        return space.fixed;
    };
    EXPECT_EQ(resolved({}), (Inputs{{"fraction", 0.4}}));
    EXPECT_EQ(resolved({{"fraction", 0.1}}), (Inputs{{"fraction", 0.1}}));
    EXPECT_EQ(resolved({{"time_step", 1e-6}}), (Inputs{{"time_step", 1e-6}}));
    EXPECT_EQ(resolved({{"law", std::string("b")}}),
              (Inputs{{"fraction", 0.4}, {"law", std::string("b")}, {"strength", 2.0}}));
    ParameterSpace space{unowned(scene), {{"amplitude", Between{0, 1}}}, {}};
    resolve_accuracy(space, "fast");
    hold(space, "time_step", 1e-6, "fast");
    hold(space, "amplitude", 0.5, "fast");
    EXPECT_EQ(space.fixed, (Inputs{{"amplitude", 0.5}, {"time_step", 1e-6}}));
    EXPECT_TRUE(space.factors.empty());
}

TEST(NearestWord, IsTheOneWithTheFewestSlips) {
    const std::vector<std::string> words = {"friction", "diameter", "gap", "speed"};
    EXPECT_EQ(nearest_word("frictoin", words), "friction");
    EXPECT_EQ(nearest_word("Diameter", words), "diameter");
    EXPECT_EQ(nearest_word("gaps", words), "gap");
    EXPECT_EQ(nearest_word("cohesion", words), "");
    EXPECT_EQ(nearest_word("", words), "");
    EXPECT_EQ(nearest_word(std::string(100'000, 'x'), words), "");
}

}  // namespace grainsweep::tests::campaign_unfold_test
