// The files of a spool: what is written is read again, and what is damaged, half or foreign is noticed.
#include "sweep/spool/spool.hpp"

#include "sweep/campaign/input_error.hpp"
#include "sweep/spool/collect.hpp"
#include "sweep/spool/task.hpp"
#include "tests/support/archive.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <fstream>
#include <limits>
#include <numeric>
#include <set>
#include <thread>

namespace grainsweep::tests::spool_files_test {

using namespace spool;

namespace fs = std::filesystem;
using campaign::Outcome;

const campaign::CaseId an_id = "0123456789abcdef0123456789abcdef";

Answer an_answer(const campaign::CaseId& id, std::int64_t attempt, Outcome outcome = Outcome::completed) {
    Answer answer;
    answer.result.attempt = {id, attempt};
    answer.result.outcome = outcome;
    answer.result.message = outcome == Outcome::completed ? "" : "line 1\nline 2";
    if (outcome == Outcome::completed) {
        answer.result.observations.scalars["y"] = 0.1 + 0.2;
        answer.result.observations.series["y_series"] = {{0, 1, std::numeric_limits<double>::quiet_NaN()}, {1, 2, 3}};
    }
    answer.result.cost.wall_seconds = 1.5;
    answer.computer = {"1", "c", "b", "avx2", "p", "node1"};
    return answer;
}

TEST(SpoolEntry, AnAnswerIsReadAsItWasWritten) {
    const auto written = an_answer(an_id, 3);
    const auto entry = entry_in(text_of(written));
    const auto* read = std::get_if<Answer>(&entry);
    ASSERT_NE(read, nullptr);
    EXPECT_EQ(read->result.attempt, written.result.attempt);
    EXPECT_EQ(read->result.observations.scalars, written.result.observations.scalars);
    ASSERT_EQ(read->result.observations.series.at("y_series").size(), 2U);
    EXPECT_TRUE(std::isnan(read->result.observations.series.at("y_series")[0].value));
    EXPECT_EQ(read->computer, written.computer);
    auto crash = an_answer(an_id, 1, Outcome::crashed);
    crash.result.cost.cpu_seconds = std::numeric_limits<double>::quiet_NaN();
    const auto failed = entry_in(text_of(crash));
    EXPECT_EQ(std::get<Answer>(failed).result.message, "line 1\nline 2");
    EXPECT_TRUE(std::isnan(std::get<Answer>(failed).result.cost.cpu_seconds));
}

TEST(SpoolEntry, EveryBeginningOfAnAnswerIsNone) {
    const std::string whole = text_of(an_answer(an_id, 1));
    for (std::size_t length = 0; length < whole.size(); ++length) {
        const auto entry = entry_in(std::string_view(whole).substr(0, length));
        EXPECT_FALSE(std::holds_alternative<Answer>(entry)) << length;
    }
}

TEST(SpoolEntry, EveryChangedByteIsNoticed) {
    const std::string whole = text_of(an_answer(an_id, 1));
    for (std::size_t at = 0; at < whole.size(); ++at) {
        std::string changed = whole;
        changed[at] = static_cast<char>(changed[at] ^ 1);
        EXPECT_FALSE(std::holds_alternative<Answer>(entry_in(changed))) << at;
    }
    EXPECT_FALSE(std::holds_alternative<Answer>(entry_in(whole + "\n")));
    EXPECT_FALSE(std::holds_alternative<Answer>(entry_in(std::string(whole.size(), '\0'))));
}

TEST(SpoolEntry, AClaimNamesItsTask) {
    EXPECT_EQ(std::get<Claim>(entry_in(text_of(Claim{"node1.7.00ff"}))).task, "node1.7.00ff");
    EXPECT_EQ(std::get<Claim>(entry_in("")).task, "") << "made, and not written yet";
    EXPECT_EQ(std::get<Claim>(entry_in("grainsweep cl")).task, "");
    EXPECT_TRUE(std::holds_alternative<Damaged>(entry_in("something else")));
}

TEST(SpoolEntry, NamesOfFiles) {
    const auto attempt = attempt_named(an_id + ".12");
    ASSERT_TRUE(attempt);
    EXPECT_EQ(attempt->case_id, an_id);
    EXPECT_EQ(attempt->number, 12);
    for (const std::string& name :
         {std::string("x"), an_id, an_id + ".", an_id + ".0", an_id + ".01", an_id + ".-1", an_id + ".1x",
          an_id + ".9999999999", an_id.substr(1) + ".1", an_id + "0.1", "G" + an_id.substr(1) + ".1"})
        EXPECT_FALSE(attempt_named(name)) << name;
}

TEST(SpoolOrder, EveryShareBeginsWithItsOwnTheLongestFirstAndGoesOnWithTheOthers) {
    const std::vector<double> predicted = {1, 5, 3, 2, 4, 6, 3};
    EXPECT_EQ(order_of(predicted, {1, 1}), (std::vector<std::uint32_t>{5, 1, 4, 2, 6, 3, 0}));
    EXPECT_EQ(order_of(predicted, {1, 2}), (std::vector<std::uint32_t>{5, 4, 6, 0, 1, 2, 3}));
    EXPECT_EQ(order_of(predicted, {2, 2}), (std::vector<std::uint32_t>{1, 2, 3, 5, 4, 6, 0}));
    std::set<std::uint32_t> first_halves;
    for (std::int64_t part = 1; part <= 3; ++part) {
        auto order = order_of(predicted, {part, 3});
        for (std::size_t k = 0; k < (part == 1 ? 3U : 2U); ++k) first_halves.insert(order[k]);
        std::ranges::sort(order);
        std::vector<std::uint32_t> all(predicted.size());
        std::iota(all.begin(), all.end(), 0U);
        EXPECT_EQ(order, all);
    }
    EXPECT_EQ(first_halves.size(), predicted.size());
}

class SpoolFolder : public testing::Test {
protected:
    SpoolFolder() : campaign(tests::small_campaign("spooled")), placed(tests::small_design(campaign, 6)) {
        cases = campaign::Cases(placed);
        asked = {folder.path(), hash_of_cases(cases), "{}"};
    }
    [[nodiscard]] Spool open() const { return {folder / "spool", asked, campaign.scene()}; }
    [[nodiscard]] campaign::CaseId id(std::size_t i) const { return placed[i].question.id; }
    void write(const std::string& name, const std::string& text) const {
        std::ofstream(folder / "spool" / "cases" / name, std::ios::binary) << text;
    }
    struct Found {
        Collected tally;
        std::vector<std::pair<campaign::CaseId, std::vector<std::int64_t>>> imported;
        std::vector<std::string> notes;
    };
    [[nodiscard]] Found collected(const std::set<campaign::CaseId>& known = {}) const {
        Found found;
        found.tally = collect(folder / "spool" / "cases", campaign, cases,
                              {[&](const campaign::CaseId& one) { return known.contains(one); },
                               [&](const campaign::CaseId& one, std::vector<Answer> answers) {
                                   std::vector<std::int64_t> numbers;
                                   for (const auto& answer : answers) numbers.push_back(answer.result.attempt.number);
                                   found.imported.emplace_back(one, numbers);
                               },
                               [&](const std::string& note) { found.notes.push_back(note); }});
        return found;
    }

    tests::Folder folder;
    campaign::Campaign campaign;
    std::vector<campaign::PlacedCase> placed;
    campaign::Cases cases;
    Asked asked;
};

TEST_F(SpoolFolder, ACaseIsClaimedOnceAndItsAnswerTakesThePlaceOfTheClaim) {
    const auto spool = open();
    EXPECT_TRUE(spool.claim({id(0), 1}, "task a"));
    EXPECT_FALSE(spool.claim({id(0), 1}, "task b"));
    EXPECT_EQ(std::get<Claim>(spool.read({id(0), 1}).value()).task, "task a");
    spool.answer(an_answer(id(0), 1));
    EXPECT_FALSE(spool.claim({id(0), 1}, "task b"));
    EXPECT_TRUE(std::holds_alternative<Answer>(spool.read({id(0), 1}).value()));
    EXPECT_FALSE(spool.read({id(0), 2}));
    EXPECT_TRUE(spool.claim({id(1), 1}, "task a"));
    spool.release({id(1), 1});
    EXPECT_TRUE(spool.claim({id(1), 1}, "task b"));
}

TEST_F(SpoolFolder, ASpoolOfOtherCasesIsRefused) {
    (void)open();
    (void)open();
    EXPECT_EQ(Spool::asked_in(folder / "spool").cases, asked.cases);
    EXPECT_EQ(Spool::asked_in(folder / "spool").text, asked.text);
    asked.cases = hash_of_cases(campaign::Cases(tests::small_design(campaign, 7)));
    EXPECT_THROW((void)open(), campaign::InputError);
    EXPECT_THROW((void)Spool::asked_in(folder.path()), campaign::InputError);
}

TEST_F(SpoolFolder, ATaskThatDoesNotTouchItsFileIsDead) {
    const auto spool = open();
    TaskFile own(spool, 2);
    std::string gone;
    {
        const TaskFile other(spool, 2);
        gone = other.name();
        EXPECT_EQ(own.state_of(gone), TaskFile::State::lives);
        const auto times = [](long back) {
            timespec now{};
            ::clock_gettime(CLOCK_REALTIME, &now);
            return std::array<timespec, 2>{timespec{now.tv_sec - back, 0}, timespec{now.tv_sec - back, 0}};
        };
        ASSERT_EQ(::utimensat(AT_FDCWD, spool.task(gone).c_str(), times(1).data(), 0), 0);
        EXPECT_EQ(own.state_of(gone), TaskFile::State::renewed);
        ASSERT_EQ(::utimensat(AT_FDCWD, spool.task(gone).c_str(), times(10).data(), 0), 0);
        EXPECT_EQ(own.state_of(gone), TaskFile::State::dead);
    }
    EXPECT_EQ(own.state_of(gone), TaskFile::State::dead) << "it has ended, and its file is gone";
}

TEST_F(SpoolFolder, WhatHasEndedIsCollectedTheLowestAnswerOnceAndFailuresBeforeIt) {
    const auto spool = open();
    campaign.limits.attempts = 2;
    spool.answer(an_answer(id(0), 1));
    spool.answer(an_answer(id(0), 2));  // of a task that was taken for dead
    spool.answer(an_answer(id(1), 1, Outcome::crashed));
    spool.answer(an_answer(id(1), 2, Outcome::abandoned));
    ASSERT_TRUE(spool.claim({id(1), 3}, "a dead task"));
    spool.answer(an_answer(id(1), 4));
    spool.answer(an_answer(id(2), 1, Outcome::crashed));
    spool.answer(an_answer(id(2), 2, Outcome::timed_out));
    spool.answer(an_answer(id(3), 1, Outcome::crashed));  // is tried again
    ASSERT_TRUE(spool.claim({id(3), 2}, "a task"));
    spool.answer(an_answer(id(4), 1));
    auto found = collected({id(4)});
    EXPECT_EQ(found.tally.imported, 3U);
    EXPECT_EQ(found.tally.known, 1U);
    EXPECT_EQ(found.tally.unusable, 0U);
    std::ranges::sort(found.imported);
    std::vector<std::pair<campaign::CaseId, std::vector<std::int64_t>>> expected = {
        {id(0), {1}}, {id(1), {1, 4}}, {id(2), {1, 2}}};
    std::ranges::sort(expected);
    EXPECT_EQ(found.imported, expected);
}

TEST_F(SpoolFolder, WhatIsDamagedHalfOrForeignIsNamedAndNotImported) {
    const auto spool = open();
    const auto whole = text_of(an_answer(id(0), 1));
    write(id(0) + ".1", whole.substr(0, whole.size() / 2));
    write(id(1) + ".1", whole);                         // under another name
    write(an_id + ".1", text_of(an_answer(an_id, 1)));  // of another campaign
    write("notes.txt", "");                             // of a user
    auto stranger = an_answer(id(2), 1);
    stranger.result.observations.scalars["unheard_of"] = 1;
    spool.answer(stranger);
    write(".node1.7.3.aside", "half");  // being written
    spool.answer(an_answer(id(3), 1));
    const auto found = collected();
    EXPECT_EQ(found.tally.imported, 1U);
    EXPECT_EQ(found.tally.unusable, 5U);
    ASSERT_EQ(found.notes.size(), 5U);
    for (const std::string& name : {id(0) + ".1", id(1) + ".1", an_id + ".1", std::string("notes.txt"), id(2) + ".1"})
        EXPECT_TRUE(std::ranges::any_of(found.notes, [&](const auto& note) { return note.find(name) != note.npos; }))
            << name;
}

// None of these is what a spool's file is; opening them must neither wait nor fill memory.
TEST_F(SpoolFolder, WhatIsNoRegularFileIsNamedAndTheRestImported) {
    const auto spool = open();
    const auto at = [&](std::size_t i) { return folder / "spool" / "cases" / (id(i) + ".1"); };
    ASSERT_EQ(::mkfifo(at(0).c_str(), 0600), 0);
    fs::create_directory(at(1));
    fs::create_symlink(at(2).filename(), at(2));
    fs::create_symlink("/dev/zero", at(3));
    write(id(4) + ".1", "");
    fs::resize_file(at(4), std::uintmax_t{1} << 40U);
    spool.answer(an_answer(id(5), 1));
    const auto found = collected();
    EXPECT_EQ(found.tally.imported, 1U);
    EXPECT_EQ(found.tally.unusable, 5U);
    const auto named = [&](std::size_t i, const std::string& why) {
        return std::ranges::any_of(found.notes, [&](const auto& note) {
            return note.find(id(i)) != note.npos && note.find(why) != note.npos;
        });
    };
    EXPECT_TRUE(named(0, "it is no regular file"));
    EXPECT_TRUE(named(1, "it is no regular file"));
    EXPECT_TRUE(named(2, "it is a link"));
    EXPECT_TRUE(named(3, "it is a link"));
    EXPECT_TRUE(named(4, "it has more than 32 MB"));
    for (std::size_t i = 0; i < 5; ++i)
        EXPECT_TRUE(std::holds_alternative<Damaged>(spool.read({id(i), 1}).value())) << i;
    fs::remove(folder / "spool" / "campaign");
    ASSERT_EQ(::mkfifo((folder / "spool" / "campaign").c_str(), 0600), 0);
    EXPECT_THROW((void)Spool::asked_in(folder / "spool"), std::runtime_error);
}

// What collect refuses no task takes for an answer.
TEST_F(SpoolFolder, AnAnswerThatItsSceneCannotGiveIsDamaged) {
    const auto spool = open();
    auto stranger = an_answer(id(0), 1);
    stranger.result.observations.scalars["unheard_of"] = 1;
    spool.answer(stranger);
    auto other_shape = an_answer(id(1), 1);
    other_shape.result.observations.scalars["y_series"] = 1;
    spool.answer(other_shape);
    for (const std::size_t i : {0U, 1U})
        EXPECT_TRUE(std::holds_alternative<Damaged>(spool.read({id(i), 1}).value())) << i;
}

TEST_F(SpoolFolder, ADateInTheFutureIsNoSignOfLife) {
    const auto spool = open();
    TaskFile own(spool, 0.3);
    const auto next_year = fs::file_time_type::clock::now() + std::chrono::hours(24 * 365);
    std::ofstream(spool.task("node.1.0")) << "";
    fs::last_write_time(spool.task("node.1.0"), next_year);
    write(id(0) + ".1", "");
    fs::last_write_time(spool.cases() / (id(0) + ".1"), next_year);
    EXPECT_EQ(own.state_of("node.1.0"), TaskFile::State::lives);
    EXPECT_FALSE(own.is_abandoned({id(0), 1}));
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    fs::last_write_time(spool.task("node.1.0"), next_year + std::chrono::seconds(1));
    EXPECT_EQ(own.state_of("node.1.0"), TaskFile::State::renewed);
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    EXPECT_EQ(own.state_of("node.1.0"), TaskFile::State::renewed) << "0.2 s after it was touched";
    EXPECT_TRUE(own.is_abandoned({id(0), 1})) << "0.4 s without a change";
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    EXPECT_EQ(own.state_of("node.1.0"), TaskFile::State::dead);
    ASSERT_EQ(::mkfifo(spool.task("node.2.0").c_str(), 0600), 0);
    EXPECT_EQ(own.state_of("node.2.0"), TaskFile::State::dead) << "no task touches that";
}

}  // namespace grainsweep::tests::spool_files_test
