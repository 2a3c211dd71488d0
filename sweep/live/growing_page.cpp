#include "sweep/live/growing_page.hpp"

#include "sweep/report/page.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <exception>
#include <utility>

namespace grainsweep::live {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double shortest_pause = 1, longest_pause = 1800;  // s
constexpr double rest = 20, alone = 2;                      // times the processor time of the last page
// Processor time beside a run, s: at once, and of each second. A short run is followed closely, a long one costs
// little.
constexpr double at_once = 0.25, of_a_second = 1.0 / 400;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Processor time of this thread, s.
double own_seconds() {
    timespec spent{};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &spent);
    return static_cast<double>(spent.tv_sec) + 1e-9 * static_cast<double>(spent.tv_nsec);
}

}  // namespace

GrowingPage::GrowingPage(std::vector<std::filesystem::path> databases, const std::atomic<std::int64_t>& told)
    : databases_(std::move(databases)), told_(told) {
    const double start = own_seconds();
    latest_ = make(1);
    last_seconds_ = own_seconds() - start;
    thread_ = std::jthread([this](const std::stop_token& stop) { keep_up(stop); });
}

GrowingPage::~GrowingPage() = default;

void GrowingPage::grown(bool computing) {
    const std::lock_guard lock(mutex_);
    grown_ = true;
    if (computing && !computing_) {
        run_began_ = Clock::now();
        spent_ = 0;
    }
    computing_ = computing;
    wake_.notify_one();
}

std::shared_ptr<const PageData> GrowingPage::latest() const {
    const std::lock_guard lock(mutex_);
    return latest_;
}

std::shared_ptr<const PageData> GrowingPage::make(std::int64_t version) const {
    auto page = std::make_shared<PageData>();
    page->version = version;
    page->covered = told_.load();
    std::vector<store::Store> stores;
    std::vector<report::PageSource> sources;
    stores.reserve(databases_.size());
    for (const auto& file : databases_) {
        stores.emplace_back(file, store::Store::Mode::read);
        sources.push_back({&stores.back(), file.filename().string()});
    }
    page->json = report::safe_in_script(report::page_data(sources));
    return page;
}

void GrowingPage::keep_up(const std::stop_token& stop) {
    ::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), 10);  // of this thread alone
    std::unique_lock lock(mutex_);
    auto last = Clock::now();
    while (!stop.stop_requested()) {
        if (!wake_.wait(lock, stop, [&] { return grown_; })) return;
        const double passed = seconds_since(last);
        const bool dear = computing_ && spent_ + last_seconds_ > at_once + of_a_second * seconds_since(run_began_);
        if (passed < std::max((computing_ ? rest : alone) * last_seconds_, shortest_pause) ||
            (dear && passed < longest_pause)) {
            wake_.wait_for(lock, stop, std::chrono::milliseconds(200), [&] { return false; });
            continue;
        }
        grown_ = false;
        const auto version = latest_->version + 1;
        lock.unlock();
        const double start = own_seconds();
        std::shared_ptr<const PageData> made;
        try {
            made = make(version);
        } catch (const std::exception& error) {  // the database is damaged or gone: the page stays unchanged
            auto failed = std::make_shared<PageData>(*latest());
            failed->error = error.what();
            made = failed;
        }
        const double took = own_seconds() - start;
        lock.lock();
        latest_ = std::move(made);
        last_seconds_ = took;
        spent_ += took;
        last = Clock::now();
    }
}

}  // namespace grainsweep::live
