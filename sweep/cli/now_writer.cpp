#include "sweep/cli/now_writer.hpp"

#include "sweep/cli/build_facts.hpp"
#include "sweep/cli/progress.hpp"

#include <unistd.h>

#include <system_error>
#include <utility>

namespace grainsweep::cli {

NowWriter::NowWriter(const std::filesystem::path& database, std::string campaign, std::size_t cores)
    : file_(live::now_file(database)), cores_(cores) {
    now_.campaign = std::move(campaign);
    now_.host = this_computer().host;
    now_.process = ::getpid();
}

NowWriter::~NowWriter() {
    std::error_code ignored;
    std::filesystem::remove(file_, ignored);
}

void NowWriter::update(const schedule::Progress& progress) {
    const auto now = Clock::now();
    const auto seconds = [&](Clock::time_point from) { return std::chrono::duration<double>(now - from).count(); };
    if (now - written_ < std::chrono::seconds(1)) return;
    written_ = now;
    const auto& tally = progress.tally;
    now_.questions = static_cast<std::int64_t>(tally.questions);
    now_.decided = static_cast<std::int64_t>(tally.decided);
    now_.failed = static_cast<std::int64_t>(tally.failed);
    now_.settled = static_cast<std::int64_t>(progress.durable);
    now_.seconds = seconds(began_);
    now_.seconds_left = seconds_left(progress, now_.seconds, cores_);
    now_.judgement = progress.judgement;
    std::erase_if(since_, [&](const auto& one) { return !progress.under_way.contains(one.first); });
    now_.running.clear();
    for (const auto& [id, one] : progress.under_way)
        now_.running.push_back({id, one.attempt, one.share, seconds(since_.try_emplace(id, now).first->second),
                                one.computer ? one.computer->host : std::string()});
    live::write_now(file_, now_);
}

}  // namespace grainsweep::cli
