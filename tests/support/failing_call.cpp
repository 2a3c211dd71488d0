#include "tests/support/failing_call.hpp"

#include "tests/support/places.hpp"

#include <cstdlib>
#include <fstream>
#include <sstream>

namespace grainsweep::tests {
namespace {

// A thousandth of a slice between checkpoints: each slice is saved.
const char* saving_often = R"("workers": 2, "launcher": ["/bin/sh", "-c", "exec \"$@\" --checkpoint-seconds 0", "sh"])";

// Not shorter than what waits for its turn inside a worker, so that a worker has one case at a time.
std::string config(const std::string& execution) {
    return R"({"campaign": "few", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]}],
        "fixed": {"noise": 0.1, "wait_seconds": 0.05}, "design": {"kind": "halton", "points": )" +
           std::to_string(SmallCampaign::cases) + R"(}, "execution": {)" + execution + "}}";
}

}  // namespace

std::string FailingCall::name() const {
    return who + ", " + when + " " + call + " " + std::to_string(number) + " of " + file + ": " + what;
}

std::vector<std::string> command_with(const FailingCall& call, const std::filesystem::path& token,
                                      const std::vector<std::string>& arguments) {
    std::ofstream(token) << "it has not happened yet\n";
    std::ostringstream order;
    order << "GRAINSWEEP_FAILING_CALL=" << call.who << ' ' << call.call << ' ' << call.file << ' ' << call.number << ' '
          << call.when << ' ' << call.what << ' ' << token.string();
    std::vector<std::string> argv = {"/usr/bin/env", "LD_PRELOAD=" + tests::failing_calls().string(), order.str(),
                                     // a sanitizer wants to be loaded first, and need not be
                                     "ASAN_OPTIONS=verify_asan_link_order=0"};
    const auto command = program_command(arguments);
    argv.insert(argv.end(), command.begin(), command.end());
    return argv;
}

bool has_happened(const std::filesystem::path& token) {
    return !std::filesystem::exists(token);
}

RemovedLogs::RemovedLogs(const std::filesystem::path& folder) : file_(folder / "removed_logs") {
    ::setenv("LD_PRELOAD", tests::failing_calls().c_str(), 1);
    ::setenv("GRAINSWEEP_REMOVED_LOGS", file_.c_str(), 1);
}

RemovedLogs::~RemovedLogs() {
    ::unsetenv("LD_PRELOAD");
    ::unsetenv("GRAINSWEEP_REMOVED_LOGS");
}

int RemovedLogs::count(const std::string& word) const {
    std::ifstream stream(file_);
    int lines = 0;
    for (std::string line; std::getline(stream, line);) lines += line.starts_with(word) ? 1 : 0;
    return lines;
}

SmallCampaign::SmallCampaign() : SmallCampaign(saving_often) {}

SmallCampaign::SmallCampaign(const std::string& execution) {
    folder_.write("c.json", config(execution));
    run_program(run_into("calm.db"), folder_.path());
    undisturbed_ = run_program({"dump", "calm.db"}, folder_.path()).out;
}

std::vector<std::string> SmallCampaign::run_into(const std::string& database) const {
    return {"run", "c.json", "--db", database, "--quiet"};
}

SmallCampaign::Trial SmallCampaign::attempt(const FailingCall& call) const {
    for (const char* left : {"d.db", "d.db-wal", "d.db-shm"}) std::filesystem::remove(folder_ / left);
    std::filesystem::remove_all(folder_ / "d.artefacts");
    Trial trial;
    const auto token = folder_ / "token";
    trial.disturbed = Process(command_with(call, token, run_into("d.db")), folder_.path()).wait();
    trial.happened = has_happened(token);
    const auto resumed = run_program(run_into("d.db"), folder_.path());
    trial.complaint = resumed.code == 0 ? complaint_of(call, "d.db") : "the next run: " + resumed.err;
    return trial;
}

std::string SmallCampaign::complaint_of(const FailingCall& call, const std::string& database) const {
    const auto ask = [&](const std::string& sql) {
        const auto ended = run_program({"query", database, sql, "--format", "csv"}, folder_.path());
        const auto line = ended.out.find('\n');
        return line == std::string::npos ? -1 : std::stoi(ended.out.substr(line + 1));
    };
    if (run_program({"dump", database}, folder_.path()).out != undisturbed_) return "another dump";
    const auto verified = run_program({"verify", database}, folder_.path());
    if (verified.code != 0) return verified.out + verified.err;
    if (ask("SELECT count(*) FROM attempt WHERE outcome = 'completed'") != cases)
        return "an answer too many or too few";
    if (ask("SELECT count(*) FROM sim_case AS c WHERE attempts <> (SELECT count(*) FROM attempt AS a WHERE a.case_key "
            "= "
            "c.case_key) OR failures <> (SELECT count(*) FROM attempt AS a WHERE a.case_key = c.case_key AND "
            "a.outcome = 'crashed')") != 0)
        return "attempts are not counted as they are stored";
    const int disturbed = ask("SELECT count(*) FROM attempt WHERE outcome <> 'completed'");
    const int crashed = ask("SELECT count(*) FROM attempt WHERE outcome = 'crashed'");
    const bool killed_worker = call.who == "worker" && call.what == "kill";
    if (crashed > (killed_worker ? 1 : 0)) return "a case has failed that has not";
    if (disturbed > (killed_worker ? 1 : workers)) return "more attempts are lost than were under way";
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / "d.artefacts"))
        return "left in its folder: " + entry.path().filename().string();
    return {};
}

}  // namespace grainsweep::tests
