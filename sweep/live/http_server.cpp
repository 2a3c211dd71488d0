#include "sweep/live/http_server.hpp"

#include "sweep/campaign/overloaded.hpp"
#include "sweep/files/system_error.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <microhttpd.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <exception>
#include <list>
#include <utility>

namespace grainsweep::live {
namespace {

using Clock = std::chrono::steady_clock;

constexpr unsigned silent_seconds = 10;
constexpr std::size_t piece = 32U << 10U;

std::string field(MHD_Connection* connection, const char* name) {
    const char* value = MHD_lookup_connection_value(connection, MHD_HEADER_KIND, name);
    return value == nullptr ? std::string() : value;
}

MHD_Result take_argument(void* into, MHD_ValueKind, const char* name, const char* value) {
    static_cast<HttpQuestion*>(into)->query.insert_or_assign(name, value == nullptr ? "" : value);
    return MHD_YES;
}

void add_common_fields(MHD_Response* response, const std::string& type, const std::string& policy) {
    const auto add = [&](const char* name, const char* value) { MHD_add_response_header(response, name, value); };
    add("Content-Type", type.c_str());
    add("Cache-Control", "no-store");
    add("X-Content-Type-Options", "nosniff");
    add("Referrer-Policy", "no-referrer");
    add("Cross-Origin-Resource-Policy", "same-origin");
    add("X-Frame-Options", "DENY");
    add("X-Accel-Buffering", "no");  // a proxy passes events on as they come
    if (!policy.empty()) add("Content-Security-Policy", policy.c_str());
}

class MicroServer final : public HttpServer {
public:
    MicroServer(std::uint16_t port, Respond respond);
    ~MicroServer() override;
    MicroServer(const MicroServer&) = delete;
    MicroServer& operator=(const MicroServer&) = delete;

    [[nodiscard]] std::uint16_t port() const override;
    void run(std::chrono::milliseconds at_most) override;
    void publish(std::string_view events) override;
    [[nodiscard]] std::size_t streams() const override { return readers_.size(); }

private:
    /// A connection that stays open for events.
    struct EventReader {
        MHD_Connection* connection = nullptr;
        std::string waiting;
        bool suspended = false, closed = false;
        std::list<EventReader>* all = nullptr;

        static ssize_t read(void* self, std::uint64_t, char* to, std::size_t most) {
            auto& reader = *static_cast<EventReader*>(self);
            if (!reader.waiting.empty()) {
                const auto count = std::min(most, reader.waiting.size());
                std::memcpy(to, reader.waiting.data(), count);
                reader.waiting.erase(0, count);
                return static_cast<ssize_t>(count);
            }
            if (reader.closed) return MHD_CONTENT_READER_END_OF_STREAM;
            reader.suspended = true;
            MHD_suspend_connection(reader.connection);
            return 0;
        }
        static void end(void* self) {
            auto* reader = static_cast<EventReader*>(self);
            reader->all->remove_if([&](const EventReader& one) { return &one == reader; });
        }
        void wake() {
            if (std::exchange(suspended, false)) MHD_resume_connection(connection);
        }
    };

    MHD_Result send(MHD_Connection* connection, const HttpAnswer& answer) const {
        static const auto nothing = std::make_shared<const std::string>();
        const auto& body = answer.body ? answer.body : nothing;
        auto* const held = new std::shared_ptr<const std::string>(body);  // until the last byte is sent
        const auto read = [](void* self, std::uint64_t at, char* to, std::size_t most) -> ssize_t {
            const auto& text = **static_cast<std::shared_ptr<const std::string>*>(self);
            if (at >= text.size()) return MHD_CONTENT_READER_END_OF_STREAM;
            const auto count = std::min(most, text.size() - static_cast<std::size_t>(at));
            std::memcpy(to, text.data() + at, count);
            return static_cast<ssize_t>(count);
        };
        const auto release = [](void* self) { delete static_cast<std::shared_ptr<const std::string>*>(self); };
        MHD_Response* response = MHD_create_response_from_callback(body->size(), piece, read, held, release);
        add_common_fields(response, answer.type, answer.policy);
        const auto queued = MHD_queue_response(connection, answer.status, response);
        MHD_destroy_response(response);
        return queued;
    }

    MHD_Result open(MHD_Connection* connection, HttpStream stream) {
        auto& reader = readers_.emplace_back();
        reader.connection = connection;
        reader.waiting = std::move(stream.first);
        reader.all = &readers_;
        MHD_Response* response =
            MHD_create_response_from_callback(MHD_SIZE_UNKNOWN, piece, &EventReader::read, &reader, &EventReader::end);
        add_common_fields(response, "text/event-stream", "");
        const auto queued = MHD_queue_response(connection, MHD_HTTP_OK, response);
        MHD_destroy_response(response);
        return queued;
    }

    /// Connection from its begin to its end.
    struct Client {
        int socket = -1;
        Clock::time_point waits_since = Clock::now();  ///< for the end of a request
        bool answered = false;                         ///< a request was not refused
        bool asks = true;                              ///< no whole request is there
    };

    static Client* client_of(MHD_Connection* connection) {
        const auto* info = MHD_get_connection_info(connection, MHD_CONNECTION_INFO_SOCKET_CONTEXT);
        return info == nullptr ? nullptr : static_cast<Client*>(info->socket_context);
    }

    static void connection_changed(void* self, MHD_Connection* connection, void** context,
                                   MHD_ConnectionNotificationCode code) {
        auto& clients = static_cast<MicroServer*>(self)->clients_;
        if (code == MHD_CONNECTION_NOTIFY_CLOSED) {
            clients.remove_if([&](const Client& one) { return &one == *context; });
            return;
        }
        const auto* info = MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CONNECTION_FD);
        auto& client = clients.emplace_back();
        client.socket = info == nullptr ? -1 : info->connect_fd;
        *context = &client;
        const auto strangers = std::ranges::count(clients, false, &Client::answered);
        if (static_cast<unsigned>(strangers) > most_strangers)
            hang_up(*std::ranges::find(clients, false, &Client::answered));
    }

    /// The server closes a connection whose other side seems to have ended.
    static void hang_up(Client& client) {
        ::shutdown(client.socket, SHUT_RDWR);
        client.asks = false;
        client.answered = true;  // it is not counted again
    }

    void end_slow_requests() {
        const auto now = Clock::now();
        for (auto& client : clients_)
            if (client.asks && now - client.waits_since > longest_request) hang_up(client);
    }

    MHD_Result answer(MHD_Connection* connection, const HttpQuestion& question) {
        auto* const client = client_of(connection);
        if (client != nullptr) client->asks = false;
        HttpReply reply;
        try {
            reply = respond_(question);
        } catch (const std::exception& error) {
            reply = HttpAnswer{.status = MHD_HTTP_INTERNAL_SERVER_ERROR,
                               .body = std::make_shared<const std::string>(error.what())};
        }
        const auto* refusal = std::get_if<HttpAnswer>(&reply);
        if (client != nullptr && (refusal == nullptr || refusal->status != MHD_HTTP_FORBIDDEN)) client->answered = true;
        return std::visit(campaign::Overloaded{[&](const HttpAnswer& one) { return send(connection, one); },
                                               [&](HttpStream& stream) { return open(connection, std::move(stream)); }},
                          reply);
    }

    static MHD_Result handle(void* self, MHD_Connection* connection, const char* path, const char* method, const char*,
                             const char* data, std::size_t* size, void** state) {
        if (*state == nullptr) {
            auto& question = *new HttpQuestion;
            *state = &question;
            question.method = method;
            question.path = path;
            question.host = field(connection, MHD_HTTP_HEADER_HOST);
            question.origin = field(connection, MHD_HTTP_HEADER_ORIGIN);
            question.last_event = field(connection, "Last-Event-ID");
            MHD_get_connection_values(connection, MHD_GET_ARGUMENT_KIND, &take_argument, &question);
            return MHD_YES;
        }
        auto& question = *static_cast<HttpQuestion*>(*state);
        if (*size > 0) {
            question.too_large = question.too_large || question.body.size() + *size > most_body;
            if (!question.too_large) question.body.append(data, *size);
            *size = 0;
            return MHD_YES;
        }
        return static_cast<MicroServer*>(self)->answer(connection, question);
    }

    static void completed(void*, MHD_Connection* connection, void** state, MHD_RequestTerminationCode) {
        if (auto* const client = client_of(connection)) {
            client->waits_since = Clock::now();
            client->asks = true;
        }
        delete static_cast<HttpQuestion*>(*state);
        *state = nullptr;
    }

    Respond respond_;
    std::list<EventReader> readers_;
    std::list<Client> clients_;
    MHD_Daemon* daemon_ = nullptr;
};

MicroServer::MicroServer(std::uint16_t port, Respond respond) : respond_(std::move(respond)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    errno = 0;
    daemon_ = MHD_start_daemon(MHD_ALLOW_SUSPEND_RESUME | MHD_USE_EPOLL, port, nullptr, nullptr, &MicroServer::handle,
                               this, MHD_OPTION_SOCK_ADDR, &address, MHD_OPTION_CONNECTION_LIMIT, most_connections,
                               MHD_OPTION_CONNECTION_TIMEOUT, silent_seconds, MHD_OPTION_NOTIFY_COMPLETED,
                               &MicroServer::completed, nullptr, MHD_OPTION_NOTIFY_CONNECTION,
                               &MicroServer::connection_changed, this, MHD_OPTION_END);
    if (daemon_ == nullptr)
        throw SystemError(fmt::format("port {} of this machine cannot be opened: {}; --port names another", port,
                                      errno == 0 ? "it is taken" : std::strerror(errno)));
}

MicroServer::~MicroServer() {
    for (auto& reader : readers_) {
        reader.closed = true;
        reader.wake();
    }
    MHD_stop_daemon(daemon_);
}

std::uint16_t MicroServer::port() const {
    return MHD_get_daemon_info(daemon_, MHD_DAEMON_INFO_BIND_PORT)->port;
}

void MicroServer::run(std::chrono::milliseconds at_most) {
    if (MHD_run_wait(daemon_, static_cast<std::int32_t>(at_most.count())) != MHD_YES)
        throw SystemError("the server cannot go on: its connections cannot be waited for");
    end_slow_requests();
}

void MicroServer::publish(std::string_view events) {
    if (events.empty()) return;  // waking a connection for nothing would turn the loop without rest
    for (auto& reader : readers_) {
        if (reader.closed) continue;
        if (reader.waiting.size() + events.size() > most_waiting) {
            reader.closed = true;
            reader.waiting.clear();
        } else {
            reader.waiting += events;
        }
        reader.wake();
    }
}

}  // namespace

std::unique_ptr<HttpServer> open_http_server(std::uint16_t port, Respond respond) {
    return std::make_unique<MicroServer>(port, std::move(respond));
}

}  // namespace grainsweep::live
