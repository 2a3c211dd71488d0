#include "sweep/workers/message.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace grainsweep::tests::workers_message_test {

using namespace workers;

TEST(Message, AQuestionSurvivesTheTrip) {
    workers::Run run;
    run.attempt = 3;
    run.question = {"0123",
                    "rehearsal",
                    2,
                    {{"x1", 0.1}, {"whole", 2.0}, {"count", std::int64_t{2}}, {"word", std::string("a \"b\"\n")}},
                    (1ULL << 63U) - 1};
    const std::string line = encode(run);
    EXPECT_EQ(line.find('\n'), std::string::npos);
    const auto back = std::get<workers::Run>(decode_to_worker(line));
    EXPECT_EQ(back.attempt, 3);
    EXPECT_EQ(back.question, run.question);  // a real that is whole stays a real
}

TEST(Message, AnAnswerSurvivesTheTripToTheLastBit) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    Done done;
    done.result.attempt = {"ab", 2};
    done.result.outcome = campaign::Outcome::unstable;
    done.result.message = "speed 3e9 m/s at \xff\n";
    done.result.observations.scalars = {{"mfr", 0.1 + 0.2}, {"undefined", nan}};
    done.result.observations.series["flux"] = {{1.0 / 3, nan, 5e-324}, {nan, 2, 1.7976931348623157e308}};
    done.result.cost = {1.5, 1.25, 1e9, {{"settle", 0.5}}, 1.75};
    done.checkpointed = true;
    const auto back = std::get<Done>(decode_to_boss(encode(done)));
    EXPECT_EQ(back.result.attempt, done.result.attempt);
    EXPECT_EQ(back.result.outcome, done.result.outcome);
    EXPECT_EQ(back.result.observations.scalars.at("mfr"), 0.1 + 0.2);
    EXPECT_TRUE(std::isnan(back.result.observations.scalars.at("undefined")));
    const auto& series = back.result.observations.series.at("flux");
    ASSERT_EQ(series.size(), 2U);
    EXPECT_EQ(series[0].time, 1.0 / 3);
    EXPECT_TRUE(std::isnan(series[0].bin));
    EXPECT_EQ(series[0].value, 5e-324);
    EXPECT_EQ(series[1].value, 1.7976931348623157e308);
    EXPECT_EQ(back.result.cost.phases.at("settle"), 0.5);
    EXPECT_EQ(back.result.cost.threads, 1.75);
    EXPECT_TRUE(back.checkpointed);
}

TEST(Message, NumbersAreWrittenAsInAllOfThisProgramsJson) {
    Done done;
    done.result.cost = {100000, 0.1, 1e16, {}, 2};
    EXPECT_NE(encode(done).find(R"("cost":{"cpu":0.1,"phases":{},"steps":1e+16,"threads":2.0,"wall":100000.0})"),
              std::string::npos)
        << encode(done);
}

TEST(Message, AnAnswerFromBeforeThreadsWereNotedIsRead) {
    std::string line = encode(Done{});
    const auto at = line.find(R"("threads":null,)");
    ASSERT_NE(at, std::string::npos);
    line.erase(at, std::string_view(R"("threads":null,)").size());
    EXPECT_TRUE(std::isnan(std::get<Done>(decode_to_boss(line)).result.cost.threads));
}

TEST(Message, NumbersOfThreadsAreWholeAndPossible) {
    EXPECT_EQ(std::get<Threads>(decode_to_worker(encode(Threads{7}))).count, 7);
    for (const char* line : {R"({"threads":0})", R"({"threads":-1})", R"({"threads":1.5})", R"({"threads":"2"})",
                             R"({"threads":null})", R"({"threads":5000})", R"({"threads":1e30})"})
        EXPECT_THROW((void)decode_to_worker(line), std::invalid_argument) << line;
}

TEST(Message, BlanksBetweenWordsSayNothing) {
    const auto spaced = [](std::string line) { return line.replace(0, 1, "{ "); };
    workers::Run run;
    run.question = {"0123", "rehearsal", 2, {{"a", -0.0}, {"b", 1e300}, {"c", std::int64_t{-5}}, {"d", 5e-324}}, 7};
    run.question.inputs["word"] = std::string("caf\xc3\xa9 \"quoted\"");
    const auto asked = std::get<workers::Run>(decode_to_worker(spaced(encode(run))));
    EXPECT_EQ(asked.question, run.question);
    Done done;
    done.result.attempt = {"0123", 2};
    done.result.observations.scalars = {{"mfr", 1.0}, {"rate", 1.0 / 3}};
    done.result.observations.series = {{"none", {}}, {"one", {{0, 1, 2}}}};
    done.result.cost = {1, 0.1, 1e9, {{"settle", 2.0}}};
    const std::string line = encode(done);
    for (const auto& text : {line, spaced(line)}) {
        const auto back = std::get<Done>(decode_to_boss(text));
        EXPECT_EQ(encode(back), line);
        EXPECT_EQ(back.result.observations.series.at("none").size(), 0U);
    }
}

TEST(Message, ALineThatIsNearlyInFormIsRefusedOrSaysSomethingElse) {
    Done done;
    done.result.attempt = {"0123", 2};
    const std::string line = encode(done);
    for (std::size_t k = 0; k < line.size(); ++k) {
        for (const char c : {'"', '}', '0', '-', '.', ' ', '\\', ','}) {
            std::string altered = line;
            altered[k] = c;
            try {
                (void)decode_to_boss(altered);
            } catch (const std::invalid_argument&) {  // a sentence
            }
        }
        EXPECT_THROW((void)decode_to_boss(line.substr(0, k)), std::invalid_argument) << k;
    }
    EXPECT_THROW((void)decode_to_boss(line + "x"), std::invalid_argument);
    for (const char* number : {"01", "+1", "nan", "inf", "1.", ".5", "0x1", "1e", "--1"}) {
        std::string altered = line;
        altered.replace(altered.find("\"wall\":") + 7, 3, number);
        EXPECT_THROW((void)decode_to_boss(altered), std::invalid_argument) << altered;
    }
}

TEST(Message, WhatAWorkerSaysOfItselfAndItsCasesSurvivesTheTrip) {
    const campaign::Computer by{"0.1.0", "abc", "feed", "avx2", "a \"processor\"", "node3"};
    const auto ready = std::get<Ready>(decode_to_boss(encode(Ready{protocol_number, by})));
    EXPECT_EQ(ready.protocol, protocol_number);
    EXPECT_EQ(ready.computer, by);
    const auto begun = std::get<Begun>(decode_to_boss(encode(Begun{{"ab", 2}, true})));
    EXPECT_EQ(begun.attempt, (campaign::Attempt{"ab", 2}));
    EXPECT_TRUE(begun.resumed);
    const auto spaced = std::get<Begun>(decode_to_boss(R"({"begun": {"attempt": 2, "id": "ab", "resumed": true}})"));
    EXPECT_EQ(spaced.attempt, begun.attempt);
    EXPECT_TRUE(spaced.resumed);
    const auto odd = std::get<Begun>(decode_to_boss(encode(Begun{{"a \"b\"", 3}, false})));
    EXPECT_EQ(odd.attempt, (campaign::Attempt{"a \"b\"", 3}));
    EXPECT_FALSE(odd.resumed);
    const auto back = std::get<GiveBack>(decode_to_boss(encode(GiveBack{{"ab", 2}, "by signal 15"})));
    EXPECT_EQ(back.attempt, (campaign::Attempt{"ab", 2}));
    EXPECT_EQ(back.reason, "by signal 15");
    EXPECT_TRUE(std::isnan(
        std::get<Alive>(decode_to_boss(encode(Alive{{"ab", 2}, std::numeric_limits<double>::quiet_NaN()}))).progress));
}

TEST(Message, AnotherProtocolIsUnderstoodAsFarAsItsNumber) {
    EXPECT_EQ(std::get<Ready>(decode_to_boss(R"({"ready":{"path":"avx2","version":"0.1.0"}})")).protocol, 1);
    EXPECT_EQ(std::get<Ready>(decode_to_boss(R"({"ready":{"news":[1],"protocol":99}})")).protocol, 99);
}

TEST(Message, HeartbeatsAreShort) {
    const std::string line = encode(ToBoss{Alive{{std::string(32, 'f'), 12}, 0.123456789012345}});
    EXPECT_LT(line.size(), 200U);
    EXPECT_EQ(std::get<Alive>(decode_to_boss(line)).progress, 0.123456789012345);
}

TEST(Message, NonsenseIsRefused) {
    for (const char* line : {"", "{", "[]", "{\"done\": 3}", "{\"run\": {}}", "hello", "{\"done\": {\"id\": \"x\"}}"}) {
        EXPECT_THROW((void)decode_to_boss(line), std::invalid_argument) << line;
        EXPECT_THROW((void)decode_to_worker(line), std::invalid_argument) << line;
    }
}

}  // namespace grainsweep::tests::workers_message_test
