#include "sweep/workers/pool.hpp"

#include "sweep/workers/awake_clock.hpp"
#include "sweep/workers/child.hpp"
#include "sweep/workers/core_sharing.hpp"
#include "sweep/workers/departures.hpp"
#include "sweep/workers/end_requests.hpp"
#include "sweep/workers/fruitless_launches.hpp"
#include "sweep/workers/hosts.hpp"
#include "sweep/workers/job_cores.hpp"
#include "sweep/workers/line_buffer.hpp"
#include "sweep/workers/message.hpp"
#include "sweep/workers/pool_worker.hpp"
#include "sweep/workers/process_start.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <deque>
#include <stdexcept>
#include <utility>

namespace grainsweep::workers {
namespace {

using namespace std::chrono_literals;
using Phase = WorkerState::Phase;
using Worker = PoolWorker;

// A case predicted to take less than this waits its turn inside the worker, so that no worker idles while
// the main program is busy.
constexpr double short_case_seconds = 0.05;
constexpr std::size_t queue_of_short_cases = 4;
// Seconds.
constexpr double lease_every = 10;
constexpr double look_every = 0.05;  // at the clock
constexpr double time_to_leave = 1;  // of a worker that gave back its case, before its place is taken
constexpr double one_request = 2;    // signals of a system within it are one request to stop
constexpr int launches_at_once = 16;
constexpr int events_at_once = 64;
constexpr int most_remarks_on_banners = 3;

std::vector<std::string> command_of(const PoolOptions& options) {
    auto argv = options.launcher;
    argv.insert(argv.end(), options.command.begin(), options.command.end());
    return argv;
}

/// For the campaign: one for each worker, of this machine no more than its job has.
std::size_t cores_of_a_node(const PoolOptions& options) {
    if (options.hosts) return options.workers / static_cast<std::size_t>(*options.hosts);
    return std::min(options.workers, job_cores());
}

bool was_killed(int status) {
    return ending_signal(status) == SIGKILL || ending_signal(status) == SIGTERM;
}

}  // namespace

struct Pool::Impl {
    explicit Impl(PoolOptions o)
        : options(std::move(o)),
          argv(command_of(options)),
          sharing(options.threads, cores_of_a_node(options)),
          fruitless(argv) {
        loop.on_readable(requests.descriptor(), [this] {
            while (const auto signal = requests.next()) interrupt(*signal);
        });
        if (!options.hosts) return;
        HostPlan plan{options.launcher, static_cast<std::size_t>(*options.hosts), cores_of_a_node(options),
                      options.limits};
        plan.argv.insert(plan.argv.end(), options.host_command.begin(), options.host_command.end());
        hosts.emplace(
            loop, std::move(plan),
            Hosts::Listener{[this] { return clock.now(); }, [this](const std::string& line) { remark_on_banner(line); },
                            [this](std::string remark) { events.emplace_back(Remark{std::move(remark)}); }});
    }

    // ---- reading -----------------------------------------------------------------------------------------

    void interrupt(int signal) {
        // The system that ends a job may signal every process of it, and the job's script may pass on the signal, too.
        const bool repeated = signal != SIGINT && clock.now() - interrupted < one_request;
        if (!repeated) events.emplace_back(Interrupted{interruptions++ > 0, signal != SIGINT});
        interrupted = clock.now();
    }

    void read(const std::shared_ptr<Worker>& worker, std::string_view piece) {
        const bool fits = worker->lines.feed(piece, [&](std::string_view line) {
            receive(worker, line);
            return worker->state.phase() != Phase::dismissed;
        });
        if (fits || worker->state.phase() == Phase::dismissed) return;
        dismiss_for(worker, fmt::format("the worker wrote a line of more than {} MB, beginning {}", longest_line >> 20U,
                                        shortened(worker->lines.begun(), 200)));
    }

    void receive(const std::shared_ptr<Worker>& worker, std::string_view line) {
        const bool fruitful = worker->state.has_begun_any();
        const bool serving = worker->state.phase() == Phase::serving;
        auto meaning = worker->state.receive(line, clock.now());
        if (!serving && worker->state.phase() == Phase::serving) place_is_new = true;
        if (!fruitful && worker->state.has_begun_any()) {
            fruitless.fruitful();
            worker->child->was_fruitful();
        }
        if (auto* finished = std::get_if<Finished>(&meaning)) {
            events.emplace_back(std::move(*finished));
        } else if (auto* beat = std::get_if<Heartbeat>(&meaning)) {
            pass_on(*worker, std::move(*beat));
        } else if (auto* back = std::get_if<GivenBack>(&meaning)) {
            events.emplace_back(std::move(*back));
            send_stop(worker);  // it is leaving: it gets no more cases and gives back the remaining ones
        } else if (const auto* banner = std::get_if<WorkerState::Banner>(&meaning)) {
            remark_on_banner(banner->line);
        } else if (auto* complaint = std::get_if<WorkerState::Complaint>(&meaning)) {
            dismiss_for(worker, std::move(complaint->why));
        }
    }

    void pass_on(Worker& worker, Heartbeat beat) {
        const double now = clock.now();
        if (now - worker.beat < Worker::beats_apart) return;
        worker.beat = now;
        events.emplace_back(std::move(beat));
    }

    void remark_on_banner(const std::string& banner) {
        if (banner.empty() || banner == last_banner) return;
        last_banner = banner;
        if (++remarks_on_banners > most_remarks_on_banners) return;
        events.emplace_back(Remark{
            fmt::format("what starts the workers wrote to standard output, where only they should: '{}'", banner)});
    }

    // ---- ends --------------------------------------------------------------------------------------------

    /// End of file: the worker is gone, or as good as.
    void lose(const std::shared_ptr<Worker>& worker) {
        worker->child->signal(SIGKILL);  // whatever is left of its process group
        worker->child->wait(2s);
        const int status = worker->child->status();
        Lost lost = worker->account(clock.now(), worker->child->end());
        lost.from_outside = worker->child->lost_with_host() || ended_from_outside(status, worker->child->log());
        lost.spoils_checkpoint = worker->state.resumed() || ending_signal(status) != SIGKILL;
        discard(worker);
        report(*worker, std::move(lost), was_killed(status));
    }

    /// It broke the protocol.
    void dismiss_for(const std::shared_ptr<Worker>& worker, std::string complaint) {
        Lost lost = worker->account(clock.now(), complaint);
        lost.spoils_checkpoint = true;
        discard(worker);
        report(*worker, std::move(lost), false);
    }

    void report(const Worker& worker, Lost lost, bool killed) {
        const bool owed = lost.running || !lost.queued.empty();
        const bool begun = worker.state.has_begun_any() || worker.child->lost_with_host();
        if (!begun && !retired) say(fruitless.ended(lost.reason, killed, workers.size(), clock.now()));
        if (owed) events.emplace_back(std::move(lost));
    }

    void say(std::optional<std::string> remark) {
        if (remark) events.emplace_back(Remark{std::move(*remark)});
    }

    /// Nothing it wrote or will write counts; its process is on its way out.
    void discard(const std::shared_ptr<Worker>& worker) {
        worker->state.dismiss();
        worker->child->close();
        std::erase(workers, worker);
        if (!worker->child->runs()) return;
        leaving.hurry(worker->child, !options.launcher.empty(), clock.now());
    }

    /// It gave back its case and is to end by itself; its place is free.
    void let_go(const std::shared_ptr<Worker>& worker) {
        Lost rest = worker->account(clock.now(), "a worker gave back what it was given");
        worker->state.dismiss();
        worker->child->close();
        std::erase(workers, worker);
        report(*worker, std::move(rest), false);
        leaving.let_go(worker->child, clock.now());
    }

    // ---- doing -------------------------------------------------------------------------------------------

    /// Returns false if no worker can be started now.
    bool launch() {
        std::error_code error;
        std::shared_ptr<Process> child;
        if (hosts) {
            child = hosts->start_worker();
            if (child == nullptr) return false;
        } else if ((child = Child::start(loop, argv, error)) == nullptr) {
            say(fruitless.not_launched(error.message(), workers.size(), clock.now()));
            return false;
        }
        auto worker = std::make_shared<Worker>(std::move(child), options.expected, clock.now());
        workers.push_back(worker);
        worker->child->listen({[this, known = std::weak_ptr(worker)](std::string_view piece) {
                                   if (const auto found = known.lock()) read(found, piece);
                               },
                               [this, known = std::weak_ptr(worker)] {
                                   if (const auto found = known.lock()) lose(found);
                               }});
        return true;
    }

    static void send(const Worker& worker, const ToWorker& message) { worker.child->write(encode(message) + "\n"); }

    void send_stop(const std::shared_ptr<Worker>& worker) {
        worker->state.stop();
        if (!std::exchange(worker->stop_sent, true)) send(*worker, Stop{});
    }

    // ---- time --------------------------------------------------------------------------------------------

    void keep_time() {
        const double now = clock.now();
        if (now - looked < look_every) return;
        looked = now;
        if (now - leased > lease_every) {
            leased = now;
            if (hosts) hosts->lease();
            for (const auto& worker : workers)
                if (worker->child->everything_is_written())
                    send(*worker, Lease{});  // else it has not read the last one yet
        }
        if (hosts) hosts->keep_time();
        const auto watched = workers;  // some may be dismissed
        for (const auto& worker : watched) {
            if (!retired && worker->state.phase() == Phase::leaving && !worker->state.running() &&
                worker->state.silence(now) > time_to_leave) {
                let_go(worker);
                continue;
            }
            say(worker->overdue_remark(options.limits, now, fruitless.command()));
            check(worker, worker->state.overdue(options.limits, now), now);
        }
        leaving.keep_time(now);
    }

    void check(const std::shared_ptr<Worker>& worker, WorkerState::Overdue overdue, double now) {
        const auto& limits = options.limits;
        if (overdue == WorkerState::Overdue::answer) {
            TimedOut late{*worker->state.running(), worker->state.waiting(),
                          fmt::format("no answer within {} s", *limits.wall), worker->state.running_seconds(now)};
            discard(worker);
            events.emplace_back(std::move(late));
        } else if (overdue == WorkerState::Overdue::silence) {
            Lost lost = worker->account(
                now, fmt::format("{} gave no sign of life for {} s and is replaced", worker->name(), *limits.silence));
            lost.from_outside = true;
            discard(worker);
            report(*worker, std::move(lost), true);
        } else if (overdue == WorkerState::Overdue::start) {
            Lost lost = worker->account(
                now, fmt::format("{} was not ready within {} s and is replaced", worker->name(), *limits.start));
            discard(worker);
            events.emplace_back(Remark{lost.reason});
            report(*worker, std::move(lost), false);
        }
    }

    // ---- where a case goes -------------------------------------------------------------------------------

    [[nodiscard]] const std::string& why_none() const {
        return hosts && !hosts->why().empty() ? hosts->why() : fruitless.why();
    }

    [[nodiscard]] std::size_t free_workers() const {
        return static_cast<std::size_t>(std::ranges::count_if(workers, [](const auto& worker) {
            return worker->state.phase() == Phase::starting ||
                   (worker->state.phase() == Phase::serving && worker->state.cases() == 0);
        }));
    }

    PoolOptions options;
    std::vector<std::string> argv;  // of a worker, with its launcher
    EndRequests requests;
    EventLoop loop;
    std::vector<std::shared_ptr<Worker>> workers;
    Departures leaving;
    std::deque<PoolEvent> events;
    AwakeClock clock;
    std::optional<Hosts> hosts;
    CoreSharing sharing;
    FruitlessLaunches fruitless;
    int events_before_reading = 0;
    bool place_is_new = false;  // a worker has become ready since the last wait
    double leased = 0, looked = 0;
    int interruptions = 0;
    double interrupted = -one_request;  // when last
    bool retired = false;
    std::string last_banner;  // remarked on
    int remarks_on_banners = 0;
};

Pool::Pool(PoolOptions options) : impl_(std::make_unique<Impl>(std::move(options))) {
    std::signal(SIGPIPE, SIG_IGN);  // a write to a dead worker is an error code, not our end
}

Pool::~Pool() {
    dismiss();
}

void Pool::expect(std::size_t cases) {
    auto& pool = *impl_;
    for (int launched = 0; launched < launches_at_once; ++launched) {
        if (pool.retired || !pool.why_none().empty() || pool.workers.size() >= pool.options.workers) return;
        const double now = pool.clock.now();
        if (pool.fruitless.waits(now) || pool.workers.size() + pool.leaving.places_taken(now) >= pool.options.workers ||
            pool.free_workers() >= cases)
            return;
        if (!pool.launch()) return;
    }
}

void Pool::share_cores(std::size_t waiting, const SecondsLeft& left) {
    impl_->sharing.share(impl_->workers, waiting, left);
}

std::optional<Place> Pool::place_for(double predicted_seconds) {
    if (!impl_->events.empty()) return std::nullopt;  // an event that is known already may end the run
    const auto& workers = impl_->workers;
    const std::size_t none = workers.size();
    std::size_t best = none;
    for (std::size_t k = 0; k < workers.size() && !(best < none && workers[best]->state.cases() == 0); ++k) {
        const auto& state = workers[k]->state;
        if (state.phase() == Phase::serving && (best == none || state.cases() < workers[best]->state.cases())) best = k;
    }
    if (best == none || impl_->retired) return std::nullopt;
    const auto& state = workers[best]->state;
    const bool queues = predicted_seconds < short_case_seconds && state.cases() < queue_of_short_cases;
    return state.cases() == 0 || queues ? std::optional(Place{best, state.computer()}) : std::nullopt;
}

void Pool::give(const Place& place, const campaign::Attempt& attempt, const campaign::Case& question) {
    const auto& worker = impl_->workers.at(place.worker);
    worker->state.give(attempt, impl_->clock.now());
    impl_->sharing.begin(*worker);
    Impl::send(*worker, Run{attempt.number, question});
}

std::optional<PoolEvent> Pool::wait(std::chrono::milliseconds at_most) {
    using Clock = std::chrono::steady_clock;
    const auto until = Clock::now() + at_most;
    // What has come is read before the clock is looked at: after events_at_once events, and no more than gives as many.
    if (impl_->events.empty() || --impl_->events_before_reading <= 0) {
        impl_->events_before_reading = events_at_once;
        for (int k = 0; k < events_at_once && impl_->loop.poll_one(); ++k) {
        }
        impl_->keep_time();
    }
    while (impl_->events.empty() && !std::exchange(impl_->place_is_new, false)) {
        if (const auto& why = impl_->why_none(); !why.empty()) throw std::runtime_error(why);
        const auto left = until - Clock::now();
        if (left <= 0s) return std::nullopt;
        impl_->loop.run_one_for(std::min(std::chrono::ceil<std::chrono::milliseconds>(left), 100ms));
        impl_->keep_time();
    }
    if (impl_->events.empty()) return std::nullopt;
    PoolEvent event = std::move(impl_->events.front());
    impl_->events.pop_front();
    return event;
}

void Pool::retire() {
    impl_->retired = true;
    if (impl_->hosts) impl_->hosts->retire();
    for (const auto& worker : impl_->workers) impl_->send_stop(worker);
}

// Workers that were retired and have nothing left to do end by themselves.
void Pool::dismiss() {
    std::vector<std::shared_ptr<Process>> all;
    for (const auto& worker : impl_->workers) {
        const bool ends_by_itself = worker->stop_sent && worker->state.was_ready() && worker->state.cases() == 0;
        worker->state.dismiss();
        if (!ends_by_itself) worker->child->signal(SIGTERM);
        all.push_back(worker->child);
    }
    if (impl_->hosts) {
        impl_->hosts->end_all(std::exchange(all, {}));
    }
    impl_->leaving.end_all(std::move(all));
    impl_->workers.clear();
}

}  // namespace grainsweep::workers
