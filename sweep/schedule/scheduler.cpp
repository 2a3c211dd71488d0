#include "sweep/schedule/scheduler.hpp"

#include "sweep/campaign/overloaded.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>
#include <vector>

namespace grainsweep::schedule {
namespace {

using campaign::Outcome;
using campaign::Overloaded;
using campaign::unanswered;
using namespace std::chrono_literals;

constexpr std::size_t last_cases = 4;      // per worker: near the end
constexpr double estimate_interval = 0.1;  // s; cases may end ten thousand times a second

}  // namespace

Scheduler::Scheduler(std::string campaign, Plan& plan, workers::WorkerPool& crew, store::Recorder& recorder,
                     Judge* judge, Watchers watchers, Walltime walltime)
    : campaign_(std::move(campaign)),
      plan_(plan),
      crew_(crew),
      recorder_(recorder),
      judge_(judge),
      watchers_(std::move(watchers)),
      walltime_(std::move(walltime)) {}

Ending Scheduler::run() {
    judge_prefix(Judge::Models::awaited);  // stored answers may be enough
    while (!at_once_) {
        hand_out();
        crew_.share_cores(plan_.waiting(), [this](const campaign::Attempt& one) { return plan_.seconds_left(one); });
        if (progress_.under_way.empty() && !plan_.next_predicted()) break;
        if (auto event = crew_.wait(200ms)) handle(std::move(*event));
        if (judge_ != nullptr && judge_->busy()) judge_prefix();
        show();
    }
    if (!at_once_) judge_prefix(Judge::Models::awaited);
    if (at_once_) {
        crew_.dismiss();
    } else {
        crew_.retire();
    }
    recorder_.drain();
    show();
    if (broken_) throw SystemError(*broken_);
    return ending();
}

Ending Scheduler::ending() const {
    const auto& tally = plan_.tally();
    if (early_ == Ending::converged) return *early_;
    if (tally.decided == tally.questions) return Ending::finished;  // a stop that comes when nothing is left is none
    if (early_) return *early_;
    if (plan_.failed_alike()) return Ending::failed_alike;
    if (plan_.left_out() > 0) {
        const bool hopeless = tally.decided + plan_.left_out() == tally.questions && !walltime_.cases_go_on &&
                              plan_.shortest_left_out() > walltime_.whole;
        return hopeless ? Ending::too_long : Ending::out_of_time;
    }
    return plan_.too_many_failures() ? Ending::too_many_failures : Ending::limited;
}

void Scheduler::look_at_time() {
    if (!walltime_.left || early_) return;
    const double left = walltime_.left();
    if (left <= 0) {
        plan_.close();
        early_ = Ending::out_of_time;
        crew_.retire();
        return;
    }
    if (walltime_.cases_go_on && left >= walltime_.shortest_part) return;
    if (const auto next = plan_.next_predicted(); next && *next > left) plan_.leave_out_longer_than(left);
}

void Scheduler::hand_out() {
    crew_.expect(plan_.waiting());
    while (true) {
        look_at_time();
        const auto predicted = plan_.next_predicted();
        if (!predicted) return;
        const auto place = crew_.place_for(*predicted);
        if (!place) return;
        const auto start = plan_.next();
        recorder_.write(store::Recorder::Begun{start->attempt, place->computer});
        crew_.give(*place, start->attempt, start->question);
        progress_.under_way.insert_or_assign(start->attempt.case_id,
                                             UnderWay{start->attempt.number, place->computer, {}, seconds()});
        time_left_.begun(start->attempt, start->predicted_seconds, seconds());
    }
}

void Scheduler::handle(workers::PoolEvent event) {
    std::visit(
        Overloaded{[&](workers::Finished& finished) { handle_finished(finished); },
                   [&](const workers::Heartbeat& beat) {
                       plan_.advanced(beat.attempt, beat.progress);
                       time_left_.reported(beat.attempt, beat.progress, seconds());
                       const auto here = progress_.under_way.find(beat.attempt.case_id);
                       if (here != progress_.under_way.end() && std::isfinite(beat.progress))
                           here->second.share = beat.progress;
                   },
                   [&](const workers::Lost& lost) {
                       if (lost.running && lost.from_outside)
                           handle_given_back(*lost.running, lost.reason, lost.seconds, true);
                       else if (lost.running)
                           handle_failure(unanswered(*lost.running, Outcome::crashed, lost.reason, lost.seconds));
                       if (lost.running && lost.spoils_checkpoint && !lost.from_outside)
                           watchers_.forget_checkpoint(lost.running->case_id);
                       take_back(lost.queued);
                   },
                   [&](const workers::TimedOut& late) {
                       handle_failure(unanswered(late.running, Outcome::timed_out, late.reason, late.seconds));
                       take_back(late.queued);
                   },
                   [&](const workers::GivenBack& back) {
                       if (back.broken && !broken_) {
                           broken_ = back.reason;
                           plan_.close();
                           crew_.retire();
                       }
                       handle_given_back(back.attempt, back.reason, back.seconds, !back.asked && !back.broken);
                   },
                   [&](const workers::Remark& remark) { watchers_.note(remark.text); },
                   [&](const workers::Interrupted& stop) {
                       plan_.close();
                       if (!early_) early_ = stop.goes_on ? Ending::asked_to_end : Ending::interrupted;
                       crew_.retire();
                       at_once_ = stop.at_once;
                   }},
        event);
}

void Scheduler::handle_finished(workers::Finished& finished) {
    // The worker reports a crash or a time-out of its program.
    if (!settles(finished.result.outcome)) return handle_failure(std::move(finished.result));
    const auto& result = finished.result;
    time_left_.ended(result.attempt, result.cost.wall_seconds, seconds());
    progress_.under_way.erase(result.attempt.case_id);
    if (plan_.ended(result.attempt, result.outcome, result.message) == Plan::Verdict::stale) return;
    if (result.outcome == Outcome::unstable || result.outcome == Outcome::rejected) {
        watchers_.note(
            fmt::format("{} {}: {}", result.attempt.case_id.substr(0, 12), to_string(result.outcome), result.message));
    }
    if (result.outcome == Outcome::completed && !result.message.empty())
        watchers_.note(fmt::format("{} completed: {}", result.attempt.case_id.substr(0, 12), result.message));
    if (judge_ != nullptr) judge_->learn(result.attempt.case_id, result.observations);
    if (finished.checkpointed) checkpointed_.push_back(result.attempt.case_id);
    recorder_.write(std::move(finished.result));
    judge_prefix();
}

void Scheduler::handle_failure(campaign::CaseResult result) {
    const auto& attempt = result.attempt;
    progress_.under_way.erase(attempt.case_id);
    time_left_.taken_back(attempt.case_id);
    const auto verdict = plan_.ended(attempt, result.outcome, result.message);
    if (verdict == Plan::Verdict::stale) return;
    watchers_.note(fmt::format("{} {} in attempt {}{}: {}", attempt.case_id.substr(0, 12), to_string(result.outcome),
                               attempt.number, verdict == Plan::Verdict::again ? ", trying again" : ", giving up",
                               result.message));
    recorder_.write(std::move(result));
    if (verdict == Plan::Verdict::gave_up) judge_prefix();
}

void Scheduler::take_back(const std::vector<campaign::Attempt>& attempts) {
    for (const auto& attempt : attempts) {
        progress_.under_way.erase(attempt.case_id);
        time_left_.taken_back(attempt.case_id);
        plan_.never_begun(attempt);
    }
}

void Scheduler::handle_given_back(const campaign::Attempt& attempt, std::string reason, double seconds, bool noted) {
    progress_.under_way.erase(attempt.case_id);
    time_left_.taken_back(attempt.case_id);
    const auto verdict = plan_.given_back(attempt);
    if (verdict == Plan::Verdict::stale) return;
    const bool gave_up = verdict == Plan::Verdict::gave_up;
    if (gave_up) reason += "; given back too often without getting further, so not tried again in this run";
    if (noted || gave_up)
        watchers_.note(fmt::format("{} given back in attempt {}{}: {}", attempt.case_id.substr(0, 12), attempt.number,
                                   gave_up ? ", giving up" : ", trying again", reason));
    recorder_.write(unanswered(attempt, Outcome::abandoned, std::move(reason), seconds));
    if (gave_up) judge_prefix();
}

void Scheduler::judge_prefix(Judge::Models models) {
    if (judge_ == nullptr || (judge_->converged_at() && judge_->stops())) return;
    for (auto& row : judge_->judge(plan_.settled_prefix(), models))
        recorder_.write(store::Recorder::Checked{campaign_, row});
    progress_.judgement = judge_->verdict();
    // Also after an interruption, because the point of convergence must not depend on the time of the check.
    if (judge_->converged_at() && judge_->stops()) {
        plan_.close();
        early_ = Ending::converged;
        recorder_.write(store::Recorder::Stopped{campaign_, *judge_->converged_at()});
    }
}

std::optional<double> Scheduler::share_to_go() const {
    if (judge_ == nullptr || !judge_->stops()) return 1;
    const auto& tally = plan_.tally();
    const auto left =
        static_cast<double>(std::min(tally.questions - tally.decided, plan_.waiting() + progress_.under_way.size()));
    const auto share = judge_->expected_share();
    if (!share || !(left > 0)) return std::nullopt;
    const double needed = *share * static_cast<double>(tally.questions) - static_cast<double>(tally.decided);
    return std::clamp(needed / left, 0.0, 1.0);
}

void Scheduler::show() {
    const auto durable = recorder_.take_durable();
    progress_.durable += durable.size();
    for (const auto& result : durable) {
        if (checkpointed_.empty()) break;
        if (std::erase(checkpointed_, result.attempt.case_id) > 0) watchers_.forget_checkpoint(result.attempt.case_id);
    }
    progress_.tally = plan_.tally();
    progress_.seconds = seconds();
    if (progress_.seconds - estimated_ > estimate_interval) {
        estimated_ = progress_.seconds;
        const double waiting = plan_.waiting() > 0 ? std::max(0.0, progress_.tally.predicted_waiting) : 0;
        const auto seconds = time_left_.estimate(waiting, plan_.workers(), progress_.seconds,
                                                 plan_.last_predicted(last_cases * plan_.workers()));
        progress_.computed = seconds.done;
        const auto share = share_to_go();
        progress_.to_compute = seconds.to_go * share.value_or(1);
        progress_.at_most = !share;
    }
    watchers_.progress(progress_);
}

}  // namespace grainsweep::schedule
