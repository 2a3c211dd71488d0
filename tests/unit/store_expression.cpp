// The `where` clause: true, false, NULL; what it may not do; the sentence for a misspelling.
#include "sweep/campaign/input_error.hpp"
#include "sweep/store/expression.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace grainsweep::tests::store_expression_test {

using testing::AllOf;
using testing::HasSubstr;

const std::vector<std::string> names = {"cohesion_law", "diameter", "gap", "particles", "select"};
const Inputs inputs = {{"cohesion_law", std::string("sjkr")},
                       {"diameter", 1e-3},
                       {"gap", 2e-3},
                       {"particles", std::int64_t{7}},
                       {"select", 1.0}};

bool holds(std::string_view expression) {
    return store::make_filter(expression, names)(inputs);
}

std::string refusal(std::string_view expression) {
    try {
        (void)store::make_filter(expression, names);
    } catch (const campaign::InputError& wrong) {
        return wrong.what();
    }
    return "accepted";
}

TEST(StoreExpression, Decides) {
    EXPECT_TRUE(holds("gap > 0.8 * diameter"));
    EXPECT_FALSE(holds("gap > 2.5 * diameter"));
    EXPECT_TRUE(holds("gap / diameter between 1.5 and 2.5 and cohesion_law in ('sjkr', 'paper')"));
    EXPECT_TRUE(holds("particles % 2 = 1"));
    EXPECT_TRUE(holds("not cohesion_law like 'p%'"));
    EXPECT_TRUE(holds("sqrt(gap * gap) = gap or pow(2, 3) = 7"));
    EXPECT_TRUE(holds("max(gap, diameter) = gap"));
    EXPECT_TRUE(holds("case when particles = 7 then true else false end"));
    EXPECT_TRUE(holds("\"gap\" > diameter -- a remark"));
    EXPECT_TRUE(holds("inputs.gap > diameter"));
    EXPECT_TRUE(holds("cohesion_law != ') (' and (gap > 0) /* ) */ -- ("));
    EXPECT_TRUE(holds("\"select\" = 1"));
    EXPECT_TRUE(holds("true"));
    EXPECT_FALSE(holds("0"));
    EXPECT_FALSE(holds("NULL"));
    EXPECT_FALSE(holds("gap / 0 > 1")) << "NULL is no yes";
    EXPECT_FALSE(holds("cohesion_law")) << "a word is no yes";
}

/// Quantities are meant: 7/2 is 3.5. What is whole by its nature stays so.
TEST(StoreExpression, QuotientsAreReal) {
    EXPECT_TRUE(holds("particles / 2 = 3.5"));
    EXPECT_TRUE(holds("gap > 1/2 * diameter and gap < 5/2*diameter"));
    EXPECT_FALSE(holds("0.0003 > 1/2 * diameter")) << "1/2 is no 0";
    EXPECT_TRUE(holds("particles*3/2 = 10.5"));
    EXPECT_TRUE(holds("7 / 2 / 2 = 1.75 and 7 / (3 / 2) * 3 = 14"));
    EXPECT_TRUE(holds("-particles/2 = -3.5 and 1 - 1/2 = 0.5"));
    EXPECT_TRUE(holds("length(cohesion_law)/3 > 1.3"));
    EXPECT_TRUE(holds("round(particles / 2) = 4 and round(1/3, 2) = 0.33"));
    EXPECT_TRUE(holds("abs(particles/2) = 3.5 and max(1/2, 1/3) = 0.5"));
    EXPECT_TRUE(holds("iif(particles > 5, 1, 2) / 4 = 0.25"));
    EXPECT_TRUE(holds("CAST(particles AS INTEGER)/2 = 3.5"));
    EXPECT_TRUE(holds("particles /* half */ / /* of it */ 2 -- a/b\n = 3.5"));
    EXPECT_TRUE(holds("cohesion_law || '/' || 'b' = 'sjkr/b'"));
    EXPECT_TRUE(holds("particles % 4 = 3 and particles % 4 / 2 = 1.5"));
    EXPECT_TRUE(holds("(particles & 3) = 3 and particles << 1 = 14 and particles >> 1 = 3 and (particles | 8) = 15"));
    EXPECT_TRUE(holds("9007199254740993 = 9007199254740992 + 1")) << "whole numbers stay whole numbers";
    EXPECT_TRUE(holds("\"gap\"/\"diameter\" = 2"));
    EXPECT_TRUE(holds("1e-3/2 = 5e-4 and 0x10/32 = 0.5"));
    Inputs others = inputs;
    const auto filter = store::make_filter("particles/1000 > 1", names);
    for (const std::int64_t n : {1000, 1001, 1500, 2000}) {
        others["particles"] = n;
        EXPECT_EQ(filter(others), n > 1000) << n;
    }
}

TEST(StoreExpression, FeaturesHaveRealQuotientsToo) {
    const std::vector<std::string> expressions = {"particles/2", "1/2 * gap", "particles % 4"};
    const std::vector<std::string> two = {"particles", "gap"};
    const auto numbers = store::make_numbers(expressions, two, "$.model.features");
    const std::vector<Value> values = {std::int64_t{7}, 0.004};
    EXPECT_THAT(numbers(values), testing::ElementsAre(3.5, 0.002, 3));
    const std::vector<std::string> chain = {"0 < gap < 1"};
    EXPECT_THROW((void)store::make_numbers(chain, two, "$.model.features"), campaign::InputError);
}

TEST(StoreExpression, AChainOfComparisonsIsRefused) {
    const auto advised = [](std::string_view expression, std::string_view instead) {
        EXPECT_THAT(refusal(expression),
                    AllOf(HasSubstr("compares the outcome of a comparison; write"), HasSubstr(std::string(instead))))
            << expression;
    };
    advised("0.2 < gap < 0.5", "'0.2 < gap AND gap < 0.5', or brackets");
    advised("0.2<gap<=2*diameter", "'0.2<gap AND gap<=2*diameter'");
    advised("gap = diameter = 1", "'gap = diameter AND diameter = 1'");
    advised("gap == diameter == particles", "'gap == diameter AND diameter == particles'");
    advised("1 > gap > diameter > 0", "'1 > gap AND gap > diameter AND diameter > 0'");
    advised("0 < gap = diameter", "'0 < gap AND gap = diameter'");
    advised("gap != diameter <> 1", "'gap != diameter AND diameter <> 1'");
    advised("particles > 1 and 0 < gap < 1 or gap > 3", "'0 < gap AND gap < 1'");
    advised("particles > 1 and (0 < gap < 1)", "'0 < gap AND gap < 1'");
    advised("max(1, 0 < gap < 1)", "'0 < gap AND gap < 1'");
    advised("not 0 < gap < 1", "'0 < gap AND gap < 1'");
    advised("case when 0 < gap < 1 then 1 else 0 end", "'0 < gap AND gap < 1'");
    advised("0 < abs(gap - 1) < 1", "'0 < abs(gap - 1) AND abs(gap - 1) < 1'");
    advised("0 < case when gap > 1 then 1 else 2 end < 3", "< 3'");
    advised("0 < gap between 1 and 2", "write brackets");
    advised("0 < /* < */ gap < 1", "gap < 1'");
    for (const std::string_view sound :
         {"0.2 < gap and gap < 0.5", "gap between 1e-3 and 3e-3 and particles > 1", "(gap < 1) = (diameter < 1)",
          "gap < 1 is true", "not gap between 1 and 2 and particles < 9 or gap = 2", "max(gap < 1, diameter < 1)",
          "case when gap < 1 then particles > 1 else gap > 2 end", "case particles when 7 then gap < 1 end",
          "cohesion_law = '< a < b' and particles << 1 < 20", "gap < 1 -- < 2", "particles in (6, 7) and gap < 1",
          "(particles > 1) + (gap < 1) = 2", "gap not between 1 and 2", "particles >= 7 and particles <= 7"})
        EXPECT_EQ(refusal(sound), "accepted") << sound;
}

// SQL puts every number before every text, and has words of its own.
TEST(StoreExpression, WhatOtherLanguagesWriteIsRefused) {
    for (const std::string_view quoted :
         {"gap < '0.5'", "gap <= '1 mm'", "'0.2' < gap", "gap between 0.2 and '0.3'", "gap between '0.2' and 0.3",
          "not gap > '.2'"})
        EXPECT_THAT(refusal(quoted), HasSubstr("is a text, and no number lies above it")) << quoted;
    EXPECT_THAT(refusal("gap > 0.5 && particles > 1"), HasSubstr("write AND"));
    EXPECT_THAT(refusal("gap > 0.5 || particles > 1"), HasSubstr("write OR"));
    EXPECT_THAT(refusal("gap > 0,5"), HasSubstr("'0,5': numbers have a decimal point"));
    for (const std::string_view sound : {"cohesion_law > 'a'", "cohesion_law = '2'", "cohesion_law || '2' > 'a'",
                                         "max(0,5) > gap", "(particles & 3) = 3", "particles in (1,2)"})
        EXPECT_EQ(refusal(sound), "accepted") << sound;
}

TEST(StoreExpression, NothingAsksNothing) {
    EXPECT_TRUE(holds(""));
    EXPECT_TRUE(holds(" \n\t"));
    EXPECT_TRUE(store::make_filter("", {})({}));
}

TEST(StoreExpression, SeesEveryCaseAnew) {
    const auto filter = store::make_filter("gap > 0.8 * diameter", names);
    const auto copy = filter;
    Inputs other = inputs;
    for (int k = 0; k < 100; ++k) {
        other["gap"] = 1e-5 * k;
        EXPECT_EQ(filter(other), std::get<double>(other["gap"]) > 0.8 * 1e-3) << k;
        EXPECT_TRUE(copy(inputs));
    }
    EXPECT_THROW((void)filter({}), std::invalid_argument);
}

TEST(StoreExpression, ASlipIsToldTheNearestName) {
    EXPECT_THAT(refusal("gpa > 1"),
                AllOf(HasSubstr("$.where"), HasSubstr("no such column: gpa"), HasSubstr("Did you mean 'gap'?")));
    EXPECT_THAT(refusal("\"gpa\" > 1"), HasSubstr("Did you mean 'gap'?")) << "no misspelt name becomes a word";
    EXPECT_THAT(refusal("sqtr(gap) > 1"), HasSubstr("Did you mean 'sqrt'?"));
    EXPECT_THAT(refusal("gap >"), HasSubstr("$.where"));
}

TEST(StoreExpression, OnlyOneDeterministicExpressionOfTheCase) {
    for (const std::string_view expression : {"random() > 0",
                                              "abs(random()) > 0",
                                              "datetime('now') > '2020'",
                                              "strftime('%s') > 0",
                                              "CURRENT_TIMESTAMP > 0",
                                              "last_insert_rowid() = 0",
                                              "changes() = 0",
                                              "sqlite_version() > '3'",
                                              "load_extension('x')",
                                              "count(*) > 0",
                                              "(SELECT 1)",
                                              "gap > (SELECT max(1))",
                                              "exists (SELECT 1)",
                                              "gap in (SELECT 1)",
                                              "1 in inputs",
                                              "1 in sqlite_schema",
                                              "gap, diameter",
                                              "gap) FROM inputs; --",
                                              "1); DROP TABLE inputs; --",
                                              "gap) FROM inputs /*",
                                              "gap)) FROM inputs /*",
                                              "1) UNION SELECT (1",
                                              "gap > 0.9) or (1",
                                              "0) + (1",
                                              "gap > 0 /* ( */ )",
                                              "gap > ?",
                                              "gap > :limit",
                                              "gap; 1",
                                              "randomblob(4) > 0",
                                              "rowid = 1",
                                              "row_number() over ()",
                                              "sum(gap) > 0",
                                              "gap = 1 collate nowhere",
                                              "-",
                                              ")",
                                              "("}) {
        EXPECT_NE(refusal(expression), "accepted") << expression;
    }
    EXPECT_THAT(refusal("random() > 0"), HasSubstr("'random' is not among the deterministic functions"));
    EXPECT_THAT(refusal("gap > (SELECT 1)"), HasSubstr("no SELECT inside"));
}

TEST(StoreExpression, AnErrorWhileEvaluatingIsAWrongQuestion) {
    const auto filter = store::make_filter("abs(particles) > 0", names);
    Inputs extreme = inputs;
    extreme["particles"] = std::numeric_limits<std::int64_t>::min();
    EXPECT_THROW((void)filter(extreme), campaign::InputError);
    EXPECT_TRUE(filter(inputs)) << "and the next case is judged as ever";
}

TEST(StoreExpression, TimeAndMemoryAreLimited) {
    const auto evaluation = [](const std::string& expression) {
        try {
            (void)holds(expression);
        } catch (const campaign::InputError& wrong) {
            return std::string(wrong.what());
        }
        return std::string("answered");
    };
    EXPECT_FALSE(holds("length(format('%1000000000d', particles)) > 100000")) << "so long a text is not made";
    std::string doubled = "'xxxxxxxxxx'";
    for (int k = 0; k < 12; ++k) doubled = "replace(" + doubled + ", 'x', 'xxxxxxxxxx')";
    EXPECT_THAT(evaluation("length(" + doubled + ") > 0"), HasSubstr("too big"));
    EXPECT_THAT(evaluation("gap > 0" + std::string(200'000, ' ')), HasSubstr("at most 100000 are read"));
    EXPECT_EQ(evaluation("gap > 0 AND cohesion_law LIKE 's%'"), "answered");
}

TEST(StoreExpression, AFeatureOfAnUnknownCollationIsAWrongQuestion) {
    const std::vector<std::string> expressions = {"gap collate nowhere"};
    EXPECT_THROW((void)store::make_numbers(expressions, names, "$.model.features"), campaign::InputError);
}

}  // namespace grainsweep::tests::store_expression_test
