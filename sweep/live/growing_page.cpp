#include "sweep/live/growing_page.hpp"

#include "sweep/live/thread_clock.hpp"
#include "sweep/report/page.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>

namespace grainsweep::live {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double shortest_pause = 1, longest_pause = 1800;  // s
constexpr double rest = 20, alone = 2;                      // times the processor time of the last page
// Processor time beside a run, s: at once, and of each second. A short run is followed closely, a long one costs
// little.
constexpr double at_once = 1, of_a_second = 1.0 / 400;
constexpr double retry_pause = 2;     // s, after an error
constexpr double most_reading = 120;  // of processor time in the statements of one database
constexpr auto longest_renewal = std::chrono::seconds(2);

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Does the work and returns the processor time. Low priority takes a thread of its own: a thread may lower its
/// priority, but not raise it again.
template <class Work>
double seconds_of(bool low_priority, const Work& work) {
    double seconds = 0;
    const auto timed = [&] {
        const double start = thread_seconds();
        work();
        seconds = thread_seconds() - start;
    };
    if (low_priority)
        std::thread([&] {
            ::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), 10);
            timed();
        }).join();
    else
        timed();
    return seconds;
}

}  // namespace

GrowingPage::GrowingPage(std::vector<std::filesystem::path> databases, std::function<bool()> ended)
    : ended_(std::move(ended)) {
    for (auto& file : databases) parts_.push_back({.file = std::move(file)});
    publish();
    thread_ = std::jthread([this](const std::stop_token& stop) { keep_up(stop); });
}

GrowingPage::~GrowingPage() = default;

bool GrowingPage::await_first(std::chrono::milliseconds at_most) {
    std::unique_lock lock(mutex_);
    return wake_.wait_for(lock, at_most, [&] { return std::ranges::all_of(parts_, &Part::read); });
}

void GrowingPage::grown(const std::filesystem::path& database, std::int64_t told, bool computing) {
    const std::lock_guard lock(mutex_);
    const auto part = std::ranges::find(parts_, database, &Part::file);
    if (part != parts_.end()) part->stale = true;
    told_ = told;
    grown_ = true;
    if (computing && !computing_) {
        run_began_ = Clock::now();
        spent_ = 0;
    }
    computing_ = computing;
    wake_.notify_all();
}

void GrowingPage::follow(const std::vector<std::filesystem::path>& databases, std::int64_t told) {
    const std::lock_guard lock(mutex_);
    std::vector<Part> parts;
    for (const auto& file : databases) {
        const auto part = std::ranges::find(parts_, file, &Part::file);
        parts.push_back(part == parts_.end() ? Part{.file = file} : *part);
    }
    parts_ = std::move(parts);
    told_ = told;
    grown_ = true;
    publish();
    wake_.notify_all();
}

std::shared_ptr<const PageData> GrowingPage::latest() const {
    const std::lock_guard lock(mutex_);
    return latest_;
}

void GrowingPage::publish() {
    auto page = std::make_shared<PageData>();
    page->version = latest_ ? latest_->version + 1 : 1;
    page->covered = told_;
    std::string names, campaigns;
    for (const auto& part : parts_) {
        const auto name = report::safe_in_script(report::Json(part.file.filename().string()));
        names += (names.empty() ? "" : ",") + name;
        if (part.campaigns && !part.campaigns->empty()) campaigns += (campaigns.empty() ? "" : ",") + *part.campaigns;
        if (part.stale) page->covered = std::min(page->covered, part.covered);
        if (!part.error.empty()) page->error += (page->error.empty() ? "" : "\n") + part.error;
    }
    page->json = fmt::format(R"({{"databases":[{}],"campaigns":[{}]}})", names, campaigns);
    const bool same = latest_ && page->json == latest_->json && page->error == latest_->error;
    if (same) page->version = latest_->version;
    latest_ = std::move(page);
}

bool GrowingPage::renew(const std::stop_token& stop, std::chrono::milliseconds at_most) {
    std::unique_lock lock(mutex_);
    const auto start = Clock::now();
    while (!stop.stop_requested() && Clock::now() - start < at_most) {
        // Each once: a run that commits all the time is no reason to read all the time.
        const auto due = std::ranges::find_if(parts_, [&](const Part& part) {
            return part.stale && part.tried < start && (part.error.empty() || seconds_since(part.tried) > retry_pause);
        });
        if (due == parts_.end()) break;
        due->stale = false;
        due->covered = told_;
        due->tried = Clock::now();
        const auto file = due->file;
        lock.unlock();
        std::shared_ptr<const std::string> campaigns;
        std::string error;
        try {
            const store::Store store(file, store::Store::Mode::read);
            store.limit(most_reading, [&] { return stop.stop_requested() || (ended_ && ended_()); });
            auto list = report::safe_in_script(report::campaigns_data({&store, file.filename().string()}));
            campaigns = std::make_shared<const std::string>(list.substr(1, list.size() - 2));
        } catch (const std::exception& broken) {
            error = broken.what();
        }
        lock.lock();
        const auto part = std::ranges::find(parts_, file, &Part::file);  // the list may be another by now
        if (part == parts_.end()) continue;
        part->read = true;
        part->error = std::move(error);
        if (campaigns) part->campaigns = std::move(campaigns);
        part->stale = part->stale || !part->error.empty();
    }
    return std::ranges::any_of(parts_, &Part::stale);
}

void GrowingPage::keep_up(const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    auto last = Clock::now() - std::chrono::hours(1);
    while (!stop.stop_requested()) {
        if (!wake_.wait(lock, stop, [&] { return grown_; })) return;
        const double passed = seconds_since(last);
        const bool first = !std::ranges::all_of(parts_, &Part::read);
        const bool dear = computing_ && spent_ + last_seconds_ > at_once + of_a_second * seconds_since(run_began_);
        if (!first && (passed < std::max((computing_ ? rest : alone) * last_seconds_, shortest_pause) ||
                       (dear && passed < longest_pause))) {
            wake_.wait_for(lock, stop, std::chrono::milliseconds(200), [&] { return false; });
            continue;
        }
        busy_ = true;
        grown_ = false;
        const bool beside_run = computing_ && !first;  // the first figures are waited for
        lock.unlock();
        bool left = false;
        const double seconds = seconds_of(beside_run, [&] { left = renew(stop, longest_renewal); });
        lock.lock();
        grown_ = left || grown_;
        busy_ = false;
        last_seconds_ = seconds;
        spent_ += seconds;
        last = Clock::now();
        publish();
        wake_.notify_all();
    }
}

}  // namespace grainsweep::live
