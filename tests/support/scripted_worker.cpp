#include "tests/support/scripted_worker.hpp"

#include <stdexcept>

namespace grainsweep::tests {
namespace {

const char* prelude = R"(ready=$("$@" </dev/null | head -n1)
say() { printf '%s\n' "$1"; }
next() {
    while IFS= read -r line; do
        [[ $line == *'"stop"'* ]] && exit 0
        [[ $line == *'"run"'* ]] || continue
        [[ $line =~ \"attempt\":([0-9]+) ]] && number=${BASH_REMATCH[1]}
        [[ $line =~ \"id\":\"([0-9a-f]+)\" ]] && id=${BASH_REMATCH[1]}
        attempt="\"attempt\":$number,\"id\":\"$id\""
        return
    done
    exit 0
}
begun() { say "{\"begun\":{$attempt,\"resumed\":false}}"; }
give_back() { say "{\"give_back\":{$attempt,\"reason\":\"by the script\"}}"; }
done_with() {
    say "{\"done\":{\"attempt\":$number,\"checkpointed\":false,\"cost\":{\"cpu\":0,\"phases\":{},\"steps\":0,\"wall\":0},\"id\":\"$id\",\"message\":\"by the script\",\"observations\":{\"scalars\":{$2},\"series\":{}},\"outcome\":\"$1\"}}"
}
)";

}  // namespace

ScriptedCampaign::ScriptedCampaign(const std::string& script, int cases, const nlohmann::json& more) {
    folder_.write("worker.sh", prelude + script);
    nlohmann::json config = {{"campaign", "scripted"},
                             {"scene", "rehearsal"},
                             {"factors", {{{"name", "x1"}, {"between", {0, 1}}}}},
                             {"design", {{"kind", "random"}, {"points", cases}}},
                             {"execution", {{"launcher", {"/bin/bash", "worker.sh"}}, {"workers", 1}}}};
    config.merge_patch(more);
    folder_.write("c.json", config.dump());
}

std::vector<std::string> ScriptedCampaign::command(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {"run", "c.json", "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return program_command(arguments);
}

Ended ScriptedCampaign::run(const std::vector<std::string>& more) const {
    return Process(command(more), folder_.path()).wait();
}

nlohmann::json ScriptedCampaign::query(const std::string& sql) const {
    const auto ended = run_program({"query", "scripted.db", sql, "--format", "json"}, folder_.path());
    if (ended.code != 0) throw std::runtime_error(ended.err);
    return nlohmann::json::parse(ended.out);
}

nlohmann::json ScriptedCampaign::ask(const std::string& sql) const {
    const auto rows = query(sql);
    return rows.size() == 1 && rows[0].size() == 1 ? rows[0].front() : nlohmann::json();
}

}  // namespace grainsweep::tests
