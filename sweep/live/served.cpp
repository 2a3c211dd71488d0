#include "sweep/live/served.hpp"

#include "sweep/campaign/case.hpp"
#include "sweep/campaign/json_writer.hpp"
#include "sweep/files/processes.hpp"
#include "sweep/files/system_error.hpp"
#include "sweep/files/whole_file.hpp"
#include "sweep/live/thread_clock.hpp"
#include "sweep/report/page.hpp"
#include "sweep/report/page_template.hpp"

#include <fmt/format.h>
#include <sys/random.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <csignal>
#include <iterator>
#include <span>
#include <sstream>
#include <system_error>

namespace grainsweep::live {
namespace {

namespace fs = std::filesystem;
using campaign::JsonText;

constexpr double least_pause = 0.4, rest_after_poll = 20;  // s; times the processor time of a poll
constexpr auto now_pause = std::chrono::seconds(1);
constexpr std::size_t most_recent = 32U << 20U;  // bytes of events kept for readers that were away
// A film takes as long as its case: SQL is still answered beside two of them.
constexpr Jobs::Bounds of_query{.most_at_once = 4, .most_bytes = 16 << 20},
    of_film{.most_at_once = 2, .most_bytes = 256 << 20};
constexpr std::string_view json_type = "application/json";
constexpr std::size_t most_open = 64;                  // databases; of more, each is closed after it was read
constexpr std::size_t most_running = 64;               // running cases that the page lists
constexpr auto first_page = std::chrono::seconds(10);  // to wait for its figures
constexpr std::array<std::string_view, 5> commands_that_run = {"run", "calibrate", "window", "accuracy", "collect"};
// Also where the page of a film was somebody else's, it would have no origin, no token and no network.
constexpr std::string_view film_policy =
    "sandbox allow-scripts allow-downloads; default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; "
    "img-src data: blob:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

std::string drawn_word(std::size_t bytes) {
    std::string raw(bytes, '\0'), word;
    if (::getrandom(raw.data(), raw.size(), 0) != static_cast<ssize_t>(raw.size()))
        throw SystemError("the system gives no random numbers for the token of the page");
    for (const char c : raw) word += fmt::format("{:02x}", static_cast<unsigned char>(c));
    return word;
}

/// Compares in the same time for every text of this length, so that the time does not reveal how many characters are
/// right.
bool same_word(std::string_view given, std::string_view right) {
    if (given.size() != right.size()) return false;
    unsigned difference = 0;
    for (std::size_t i = 0; i < right.size(); ++i)
        difference |= static_cast<unsigned char>(given[i]) ^ static_cast<unsigned char>(right[i]);
    return difference == 0;
}

std::string_view without_port(std::string_view host) {
    return host.substr(0, host.starts_with('[') ? host.find(']') + 1 : host.find(':'));
}

std::string_view argument(const HttpQuestion& question, std::string_view name) {
    const auto found = question.query.find(name);
    return found == question.query.end() ? std::string_view{} : std::string_view(found->second);
}

HttpReply refused(unsigned status, std::string sentence) {
    return HttpAnswer{.status = status, .body = std::make_shared<const std::string>(std::move(sentence) + "\n")};
}

HttpReply json(const JsonText& value, unsigned status = 200) {
    return HttpAnswer{
        .status = status, .type = std::string(json_type), .body = std::make_shared<const std::string>(value.text())};
}

constexpr std::string_view no_token = "the token is wrong: open the address that `grainsweep serve` printed";

HttpReply wrong_token() {
    return refused(403, std::string(no_token));
}

/// Refuses a page without token. A tab that was reloaded has kept the token, and opens the page with it.
HttpReply way_back() {
    constexpr std::string_view script =
        "const kept = sessionStorage.getItem(\"grainsweep \" + location.pathname);\n"
        "if (kept && !location.search) location.replace(\"?token=\" + kept);\n";
    return HttpAnswer{.status = 403,
                      .type = "text/html; charset=utf-8",
                      .body = std::make_shared<const std::string>(fmt::format(
                          "<!doctype html><meta charset=\"utf-8\"><p>{}</p><script>{}</script>\n", no_token, script)),
                      .policy = "default-src 'none'; script-src " + report::script_sources({script})};
}

bool is_case_id(std::string_view word) {
    return word.size() == 32 && word.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

/// Whether this process has the file open: the number comes from a file that anybody may have written.
bool has_open(std::int64_t process, const fs::path& file) {
    std::error_code error;
    const fs::directory_iterator open_files(fmt::format("/proc/{}/fd", process), error);
    return !error && std::ranges::any_of(open_files, [&](const auto& one) {
        std::error_code ignored;
        return fs::equivalent(one.path(), file, ignored);
    });
}

/// Whether this process is a run of this program into the file.
bool is_run_into(std::int64_t process, const fs::path& file) {
    if (process <= 1 || process == ::getpid()) return false;
    std::error_code error;
    const auto program = fs::read_symlink(fmt::format("/proc/{}/exe", process), error).filename().string();
    if (error || !program.starts_with("grainsweep")) return false;
    const auto words = files::whole_file(fmt::format("/proc/{}/cmdline", process), error);
    const auto command = std::string(words.c_str() + std::min(words.size(), words.find('\0') + 1));
    return std::ranges::count(commands_that_run, command) > 0 && has_open(process, file);
}

std::vector<Follower> follow_all(const std::vector<fs::path>& databases, const std::function<bool()>& ended) {
    std::vector<Follower> followers;
    followers.reserve(databases.size());
    for (const auto& file : databases) followers.emplace_back(file, ended);
    return followers;
}

JsonText now_json(const Follower& follower) {
    JsonText running;
    if (const auto now = read_now(follower.file())) {
        const auto shown = std::min(now->running.size(), most_running);
        const auto running_json = [](const RunningCase& one) {
            return JsonText{{"case", one.case_id},
                            {"attempt", one.attempt},
                            {"share", one.share},
                            {"seconds", one.seconds},
                            {"host", one.host}};
        };
        running = {{"campaign", now->campaign},
                   {"host", now->host},
                   {"questions", now->questions},
                   {"decided", now->decided},
                   {"failed", now->failed},
                   {"settled", now->settled},
                   {"seconds", now->seconds},
                   {"seconds_left", now->seconds_left},
                   {"at_most", now->at_most},
                   {"judgement", now->judgement},
                   {"running", JsonText::list(std::span(now->running).first(shown), running_json)},
                   {"running_more", now->running.size() - shown}};
    }
    return {{"database", follower.file().filename().string()},
            {"in_place", follower.in_place()},
            {"error", follower.error()},
            {"run", running}};
}

}  // namespace

std::string new_token() {
    return drawn_word(16);
}

Served::Served(const std::vector<fs::path>& databases, std::optional<Control> control, std::string token, Proxy proxy,
               std::function<bool()> ended)
    : token_(std::move(token)),
      run_(drawn_word(4)),
      ended_(std::move(ended)),
      followers_(follow_all(databases, ended_)),
      control_(std::move(control)),
      proxy_(std::move(proxy)),
      page_(databases, ended_) {
    (void)page_.await_first(first_page);
    version_ = page_.latest()->version;
}

void Served::end_work() {
    jobs_.end();
    films_folder_.remove();
}

void Served::follow(const std::vector<fs::path>& databases) {
    std::vector<Follower> followers;
    followers.reserve(databases.size());
    for (const auto& file : databases) {
        const auto known = std::ranges::find(followers_, file, &Follower::file);
        followers.push_back(known == followers_.end() ? Follower(file, ended_) : std::move(*known));
    }
    followers_ = std::move(followers);
    page_.follow(databases, told_);
}

std::string Served::event(std::string_view kind, std::string_view data, std::int64_t number) const {
    return fmt::format("id: {}-{}\nevent: {}\ndata: {}\n\n", run_, number, kind, data);
}

std::string Served::now_event() const {
    return event("now",
                 JsonText{{"databases", JsonText::list(followers_, now_json)}, {"error", page_.latest()->error}}.text(),
                 told_);
}

std::string Served::look() {
    const auto now = Clock::now();
    const auto since = [&](Clock::time_point then) { return std::chrono::duration<double>(now - then).count(); };
    std::string events;
    if (since(polled_) >= std::max(least_pause, rest_after_poll * poll_seconds_)) {
        const double start = thread_seconds();
        for (auto& follower : followers_) {
            auto results = follower.poll();
            if (followers_.size() > most_open) follower.rest();
            const bool anew = follower.take_anew();
            if (results.empty()) {
                if (anew) page_.grown(follower.file(), told_, computing_);
                continue;
            }
            JsonText list = JsonText::array();
            for (const auto& one : results) list.push_back(one);
            told_ += static_cast<std::int64_t>(results.size());
            auto text =
                event("results", JsonText{{"database", follower.file().filename().string()}, {"results", list}}.text(),
                      told_);
            events += text;
            recent_bytes_ += text.size();
            recent_.emplace_back(told_, std::move(text));
            page_.grown(follower.file(), told_, computing_);
        }
        while (recent_bytes_ > most_recent && recent_.size() > 1) {
            recent_bytes_ -= recent_.front().second.size();
            recent_.pop_front();
        }
        polled_ = Clock::now();
        poll_seconds_ = thread_seconds() - start;
    }
    if (const auto latest = page_.latest(); latest->version != version_) {
        version_ = latest->version;
        events += event("page", JsonText{{"version", version_}}.text(), told_);
    }
    if (now - said_now_ >= now_pause) {
        said_now_ = now;
        const bool before = computing_;
        computing_ = std::ranges::any_of(followers_, [](const auto& one) { return read_now(one.file()).has_value(); });
        if (before && !computing_)  // the last figures of the run
            for (const auto& follower : followers_) page_.grown(follower.file(), told_, false);
        events += now_event();
    }
    return events;
}

bool Served::is_own_name(std::string_view host) const {
    const auto name = without_port(host);
    return name == "127.0.0.1" || name == "localhost" || name == "[::1]" || std::ranges::count(proxy_.hosts, name) > 0;
}

bool Served::is_own_origin(const HttpQuestion& question) const {
    const std::string_view origin = question.origin;
    if (origin == "http://" + question.host) return true;
    const auto scheme = origin.find("://");  // a proxy may speak https, and send another Host field
    return scheme != std::string_view::npos &&
           std::ranges::count(proxy_.hosts, without_port(origin.substr(scheme + 3))) > 0;
}

HttpReply Served::answer(const HttpQuestion& question) {
    if (question.too_large)
        return refused(413, fmt::format("the question has more than {} bytes", HttpServer::most_body));
    if (!is_own_name(question.host))
        return refused(403, "this server answers to names of its own machine, and to --host-name, only");
    const bool asks = question.method == "GET", acts = question.method == "POST";
    std::string_view path = question.path;
    if (path.starts_with(proxy_.base_path)) path.remove_prefix(proxy_.base_path.size() - 1);
    if (asks && path == "/film" && question.query.contains("ticket"))
        return film_of(std::string(argument(question, "ticket")));
    if (!same_word(argument(question, "token"), token_)) return asks && path == "/" ? way_back() : wrong_token();
    if (asks && path == "/") return page();
    if (asks && path == "/data") return data();
    if (asks && path == "/events") return events(question);
    if (asks && path == "/job") return job(question);
    if (asks && path == "/film") return film(question);
    if (acts && !question.origin.empty() && !is_own_origin(question))
        return refused(403, "a page of another origin may not ask this");
    if (acts && path == "/query") return start_query(question);
    if (acts && path == "/film") return start_film(question);
    if (acts && (path == "/stop" || path == "/run" || path == "/again" || path == "/more"))
        return steer(question, path);
    return asks || acts ? refused(404, "there is no such page") : refused(405, "only GET and POST");
}

HttpReply Served::page() const {
    std::ostringstream stream;
    JsonText configs;  // null: control is not permitted
    if (control_)
        configs = JsonText::list(control_->configs, [](const fs::path& file) { return file.filename().string(); });
    const auto policy =
        report::write_live_page(stream, fmt::format("{},\"event\":\"{}-{}\",\"steerable\":{}}}",
                                                    page_.latest()->json.substr(0, page_.latest()->json.size() - 1),
                                                    run_, page_.latest()->covered, configs.text()));
    return HttpAnswer{.type = "text/html; charset=utf-8",
                      .body = std::make_shared<const std::string>(std::move(stream).str()),
                      .policy = policy};
}

HttpReply Served::data() const {
    const auto latest = page_.latest();
    return HttpAnswer{
        .type = std::string(json_type),
        .body = std::make_shared<const std::string>(fmt::format(
            "{},\"event\":\"{}-{}\"}}", latest->json.substr(0, latest->json.size() - 1), run_, latest->covered))};
}

HttpReply Served::events(const HttpQuestion& question) const {
    const std::string_view since = question.last_event.empty() ? argument(question, "since") : question.last_event;
    std::int64_t number = -1;
    if (since.starts_with(run_ + "-"))
        std::from_chars(since.data() + run_.size() + 1, since.data() + since.size(), number);
    std::string first = "retry: 1000\n\n";
    const bool missed =
        number < 0 || number > told_ || (!recent_.empty() && number < told_ && number + 1 < recent_.front().first);
    if (missed) first += event("page", JsonText{{"version", version_}}.text(), told_);
    for (const auto& [last, text] : recent_)
        if (last > number) first += text;
    first += now_event();
    if (argument(question, "once").empty()) return HttpStream{std::move(first)};
    return HttpAnswer{.type = "text/event-stream", .body = std::make_shared<const std::string>(std::move(first))};
}

const Follower* Served::asked(const HttpQuestion& question) const {
    const auto name = argument(question, "database");
    for (const auto& follower : followers_)
        if (follower.file().filename().string() == name) return &follower;
    return name.empty() && followers_.size() == 1 ? &followers_.front() : nullptr;
}

Follower* Served::asked(const HttpQuestion& question) {
    return const_cast<Follower*>(std::as_const(*this).asked(question));
}

const fs::path* Served::config_of(const HttpQuestion& question) const {
    const auto name = argument(question, "config");
    for (const auto& file : control_->configs)
        if (file.filename().string() == name) return &file;
    return name.empty() && control_->configs.size() == 1 ? &control_->configs.front() : nullptr;
}

HttpReply Served::start_query(const HttpQuestion& question) {
    const auto* follower = asked(question);
    if (follower == nullptr) return refused(404, "there is no such database");
    if (question.body.empty()) return refused(400, "the question is empty");
    const auto file = fs::absolute(follower->file());
    const auto number =
        jobs_.start({"query", "--format", "json", "--limit-seconds", "10", "--", file.string(), question.body},
                    file.parent_path(), of_query);
    return number ? json({{"job", *number}}) : refused(503, "too much is asked at once; ask again");
}

fs::path Served::film_file(const std::string& ticket) const {
    return films_folder_.path() / (ticket + ".html");
}

HttpReply Served::start_film(const HttpQuestion& question) {
    auto* follower = asked(question);
    const std::string id(argument(question, "case"));
    if (follower == nullptr || !is_case_id(id)) return refused(404, "there is no such case");
    const auto file = fs::absolute(follower->file());
    const std::pair key(file.string(), id);
    const auto film_json = [](const Film& film) { return JsonText{{"film", "film?ticket=" + film.ticket}}; };
    std::error_code error;
    if (const auto made = films_.find(key); made != films_.end()) {
        if (made->second.whole && fs::exists(film_file(made->second.ticket), error))
            return json(film_json(made->second));
        if (jobs_.is_running(made->second.job)) return json(film_json(made->second).add("job", made->second.job));
    }
    Film film{drawn_word(16), follower->is_settled(id)};
    const auto number = jobs_.start({"replay", file.string(), id, "--watch", film_file(film.ticket).string()},
                                    file.parent_path(), of_film);
    if (!number) return refused(503, "too much is asked at once; ask again");
    film.job = *number;
    return json(film_json(films_.insert_or_assign(key, film).first->second).add("job", *number));
}

HttpReply Served::film(const HttpQuestion& question) const {
    const auto* follower = asked(question);
    const std::string id(argument(question, "case"));
    if (follower == nullptr || !is_case_id(id)) return refused(404, "there is no such case");
    const auto made = films_.find({fs::absolute(follower->file()).string(), id});
    return film_of(made == films_.end() ? "" : made->second.ticket);
}

HttpReply Served::film_of(const std::string& ticket) const {
    const bool known =
        std::ranges::any_of(films_, [&](const auto& one) { return same_word(one.second.ticket, ticket); });
    std::error_code error;
    auto text = known ? files::regular_file(film_file(ticket), error, of_film.most_bytes) : std::string();
    if (!known || error) return refused(404, "this server has made no such film yet");
    return HttpAnswer{.type = "text/html; charset=utf-8",
                      .body = std::make_shared<const std::string>(std::move(text)),
                      .policy = std::string(film_policy)};
}

HttpReply Served::job(const HttpQuestion& question) {
    const auto word = argument(question, "number");
    std::int64_t number = 0;
    std::from_chars(word.data(), word.data() + word.size(), number);
    const auto state = jobs_.look_at(number);
    if (!state.known) return refused(404, "there is no such job");
    if (!state.ended) return json({{"running", true}});
    return json({{"code", state.ended->code}, {"out", state.ended->out}, {"err", state.ended->err}});
}

HttpReply Served::steer(const HttpQuestion& question, std::string_view path) {
    if (!control_) return refused(403, "`grainsweep serve --control FILE` allows this");
    auto* follower = asked(question);
    if (follower == nullptr) return refused(404, "there is no such database");
    const auto file = fs::absolute(follower->file());
    const bool runs = follower->is_being_written();  // the file that says so may be anybody's
    if (path == "/stop") {
        const auto now = read_now(file);
        if (!now || !runs) return refused(409, "nothing runs");
        if (now->host != files::own_host()) return refused(409, fmt::format("the run is on host {}", now->host));
        if (!is_run_into(now->process, file) || ::kill(static_cast<pid_t>(now->process), SIGINT) != 0)
            return refused(409, "the run has ended");
        return json({{"stopping", true}});
    }
    const auto* config = config_of(question);
    if (config == nullptr) return refused(404, "there is no such campaign file");
    std::vector<std::string> arguments = {"run", fs::absolute(*config).string(), "--db", file.string()};
    if (path == "/again") {
        const auto outcome = argument(question, "outcome");
        if (!campaign::outcome_named(outcome)) return refused(400, "there is no such outcome");
        arguments.insert(arguments.end(), {"--again", std::string(outcome)});
    }
    if (path == "/more") {
        const auto points = argument(question, "points");
        std::int64_t count = 0;
        const auto [end, error] = std::from_chars(points.data(), points.data() + points.size(), count);
        if (error != std::errc() || end != points.data() + points.size() || count < 1)
            return refused(400, "the number of points must be a whole number, at least 1");
        arguments.insert(arguments.end(), {"--points", std::string(points)});
    }
    if (runs || runner_.running()) return refused(409, "a run is under way; stop it first");
    if (!runner_.start(arguments, file)) return refused(503, "the run cannot be started");
    return json({{"started", true}});
}

}  // namespace grainsweep::live
