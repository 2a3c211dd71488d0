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
    if (now - written_ < std::chrono::seconds(1)) return;
    written_ = now;
    const auto& tally = progress.tally;
    now_.questions = static_cast<std::int64_t>(tally.questions);
    now_.decided = static_cast<std::int64_t>(tally.decided);
    now_.failed = static_cast<std::int64_t>(tally.failed);
    now_.settled = static_cast<std::int64_t>(progress.durable);
    now_.seconds = progress.seconds;
    now_.seconds_left = seconds_left(progress, cores_);
    now_.at_most = progress.at_most;
    now_.judgement = progress.judgement;
    now_.running.clear();
    for (const auto& [id, one] : progress.under_way)
        now_.running.push_back({id, one.attempt, one.share, progress.seconds - one.given,
                                one.computer ? one.computer->host : std::string()});
    live::write_now(file_, now_);
}

}  // namespace grainsweep::cli
