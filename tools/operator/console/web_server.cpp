#include "operator/console/web_server.h"

#include <algorithm>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <vector>

#include <libwebsockets.h>
#include <sodium.h>
#include <unistd.h>

#include "operator/console/page.h"

namespace console
{

namespace
{

constexpr lws_usec_t link_period_us = 250000;
constexpr size_t longest_page_message = 1024;

/* The page needs nothing from elsewhere, and nobody may frame it. */
constexpr std::string_view security_policy =
    "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; img-src 'self' data:; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

std::string_view text_of(const void *data, size_t length)
{
    return data == nullptr ? std::string_view() : std::string_view(static_cast<const char *>(data), length);
}

const char *content_type(std::string_view name)
{
    const std::string_view ending = name.substr(std::min(name.rfind('.'), name.size()));
    return ending == ".html"  ? "text/html; charset=utf-8"
           : ending == ".css" ? "text/css; charset=utf-8"
           : ending == ".js"  ? "text/javascript; charset=utf-8"
           : ending == ".svg" ? "image/svg+xml"
                              : "application/octet-stream";
}

const ale_page_file_t *find_page_file(std::string_view path)
{
    const std::string_view name = path == "/" ? "index.html" : path.substr(std::min<size_t>(1, path.size()));
    const ale_page_file_t *end = ale_page_files + ale_page_file_count;
    const auto *found =
        std::find_if(ale_page_files, end, [&](const auto &file) { return name == file.name; });
    return found == end ? nullptr : found;
}

std::string header(lws *connection, lws_token_indexes token)
{
    std::vector<char> text(static_cast<size_t>(lws_hdr_total_length(connection, token)) + 1);
    const int length = lws_hdr_copy(connection, text.data(), static_cast<int>(text.size()), token);
    return length > 0 ? std::string(text.data(), static_cast<size_t>(length)) : std::string();
}

/* Of the address, as in ?robot=rover1; empty: it is not there. */
std::string argument(lws *connection, const char *name)
{
    const std::string_view wanted(name);
    for (int k = 0;; k++) {
        const int length = lws_hdr_fragment_length(connection, WSI_TOKEN_HTTP_URI_ARGS, k);
        if (length <= 0) {
            return "";
        }
        std::string text(static_cast<size_t>(length) + 1, '\0');
        lws_hdr_copy_fragment(connection, text.data(), length + 1, WSI_TOKEN_HTTP_URI_ARGS, k);
        text.pop_back();
        if (text.compare(0, wanted.size(), wanted) == 0) {
            return text.substr(wanted.size());
        }
    }
}

bool add_header(lws *connection, const char *name, std::string_view value, unsigned char **at,
                unsigned char *end)
{
    return lws_add_http_header_by_name(connection, reinterpret_cast<const unsigned char *>(name),
                                       reinterpret_cast<const unsigned char *>(value.data()),
                                       static_cast<int>(value.size()), at, end) == 0;
}

/* Sends one file whole; what the socket does not take at once is buffered by the library. */
int serve_file(lws *connection, const ale_page_file_t &file)
{
    std::vector<unsigned char> buffer(LWS_PRE + 1024);
    unsigned char *start = buffer.data() + LWS_PRE;
    unsigned char *at = start;
    unsigned char *end = buffer.data() + buffer.size();
    if (lws_add_http_common_headers(connection, HTTP_STATUS_OK, content_type(file.name), file.size, &at,
                                    end) != 0 ||
        !add_header(connection, "content-security-policy:", security_policy, &at, end) ||
        !add_header(connection, "x-content-type-options:", "nosniff", &at, end) ||
        !add_header(connection, "referrer-policy:", "no-referrer", &at, end) ||
        !add_header(connection, "cache-control:", "no-cache", &at, end) ||
        lws_finalize_write_http_header(connection, start, &at, end) != 0) {
        return -1;
    }
    std::vector<unsigned char> body(LWS_PRE + file.size);
    std::memcpy(body.data() + LWS_PRE, file.bytes, file.size);
    if (lws_write(connection, body.data() + LWS_PRE, file.size, LWS_WRITE_HTTP_FINAL) < 0) {
        return -1;
    }
    return lws_http_transaction_completed(connection) != 0 ? -1 : 0;
}

std::string peer_of(lws *connection)
{
    char address[64] = "";
    lws_get_peer_simple(connection, address, sizeof address);
    return address;
}

constexpr char token_wanted[] =
    "<p>This console wants its token: open the address that ale-console printed when it started.";

constexpr char no_such_robot[] =
    "<p>This console has no robot of that name: open the address that ale-console printed when it started.";

int serve(lws *connection, std::string_view path, bool has_token)
{
    const ale_page_file_t *file = find_page_file(path);
    if (file == nullptr) {
        return lws_return_http_status(connection, HTTP_STATUS_NOT_FOUND, nullptr);
    }
    if (std::string_view(file->name) == "index.html" && !has_token) {
        return lws_return_http_status(connection, HTTP_STATUS_FORBIDDEN, token_wanted);
    }
    return serve_file(connection, *file);
}

} // namespace

/* What the library calls, given names. */
struct WebCallbacks {
    /* The timer must be the first member: the library hands back its address. */
    struct LinkTimer {
        lws_sorted_usec_list_t list{};
        WebServer *server = nullptr;
    };

    static int on_event(lws *connection, lws_callback_reasons reason, void *, void *data, size_t length)
    {
        auto *server = static_cast<WebServer *>(lws_context_user(lws_get_context(connection)));
        const std::string_view text = text_of(data, length);
        switch (reason) {
        case LWS_CALLBACK_SERVER_NEW_CLIENT_INSTANTIATED:
            server->came(connection);
            return 0;
        case LWS_CALLBACK_WSI_DESTROY:
            server->left(connection);
            return 0;
        case LWS_CALLBACK_HTTP:
            return answer_request(*server, connection, text);
        case LWS_CALLBACK_FILTER_PROTOCOL_CONNECTION:
            return admit(*server, connection);
        case LWS_CALLBACK_ESTABLISHED:
            return established(*server, connection);
        case LWS_CALLBACK_HTTP_WRITEABLE:
            return server->send_file(connection);
        case LWS_CALLBACK_SERVER_WRITEABLE:
            return server->send_next(connection);
        case LWS_CALLBACK_RECEIVE:
            return received(*server, connection, text);
        case LWS_CALLBACK_CLOSED:
            server->connections_.erase(connection);
            return 0;
        case LWS_CALLBACK_EVENT_WAIT_CANCELLED:
            server->woken();
            return 0;
        default:
            return lws_callback_http_dummy(connection, reason, nullptr, data, length);
        }
    }

    static int answer_request(WebServer &server, lws *connection, std::string_view path)
    {
        const bool has_token = server.has_token(connection);
        if (has_token) {
            server.antechamber_.renew(connection, Antechamber::Clock::now());
        }
        if (lws_hdr_total_length(connection, WSI_TOKEN_GET_URI) <= 0) {
            return lws_return_http_status(connection, HTTP_STATUS_METHOD_NOT_ALLOWED, nullptr);
        }
        const std::optional<Wanted> wanted = wanted_of(path);
        Robot *robot = has_token ? server.robot_of(connection) : nullptr;
        if (has_token && robot == nullptr) {
            return lws_return_http_status(connection, HTTP_STATUS_NOT_FOUND, no_such_robot);
        }
        return wanted ? download(server, connection, *wanted, robot) : serve(connection, path, has_token);
    }

    /* Who has the token may take as long as the file is large. robot: nullptr for who has none. */
    static int download(WebServer &server, lws *connection, const Wanted &wanted, Robot *robot)
    {
        if (robot == nullptr) {
            return lws_return_http_status(connection, HTTP_STATUS_FORBIDDEN, token_wanted);
        }
        server.antechamber_.leave(connection);
        return robot->desk().fetch(connection, wanted)
                   ? 0
                   : lws_return_http_status(connection, HTTP_STATUS_SERVICE_UNAVAILABLE, nullptr);
    }

    static int admit(WebServer &server, lws *connection)
    {
        if (!server.accepts(connection)) {
            return refuse(connection, HTTP_STATUS_FORBIDDEN);
        }
        Robot *robot = server.robot_of(connection);
        lws_set_opaque_user_data(connection, robot); /* the address is forgotten once it is let in */
        return robot != nullptr ? 0 : refuse(connection, HTTP_STATUS_NOT_FOUND);
    }

    static int refuse(lws *connection, unsigned status)
    {
        lws_return_http_status(connection, status, nullptr);
        return -1;
    }

    static int established(WebServer &server, lws *connection)
    {
        auto *robot = static_cast<Robot *>(lws_get_opaque_user_data(connection));
        server.antechamber_.leave(connection);
        server.connections_.emplace(connection, server.new_connection(connection, *robot));
        lws_callback_on_writable(connection);
        return 0;
    }

    static int received(WebServer &server, lws *connection, std::string_view part)
    {
        const auto found = server.connections_.find(connection);
        if (found == server.connections_.end()) {
            return -1;
        }
        std::string &heard = found->second.heard;
        heard += part;
        if (heard.size() > longest_page_message) {
            return -1;
        }
        if (lws_is_final_fragment(connection) == 0 || lws_remaining_packet_payload(connection) > 0) {
            return 0;
        }
        const bool understood = found->second.client.heard(heard);
        heard.clear();
        lws_callback_on_writable(connection);
        return understood ? 0 : -1;
    }

    static void on_link_timer(lws_sorted_usec_list_t *list)
    {
        auto *timer = reinterpret_cast<LinkTimer *>(list);
        timer->server->links_due();
        schedule(*timer);
    }

    static void schedule(LinkTimer &timer)
    {
        lws_sul_schedule(timer.server->context_, 0, &timer.list, on_link_timer, link_period_us);
    }
};

namespace
{

const lws_protocols protocols[] = {{"ale-console", WebCallbacks::on_event, 0, 1024, 0, nullptr, 0},
                                   {nullptr, nullptr, 0, 0, 0, nullptr, 0}};

/* A browser that is gone without a word (a tablet carried out of the room) is let go after half a minute. */
const lws_retry_bo_t keep_alive = {nullptr, 0, 0, 15, 30, 0};

} // namespace

WebServer::WebServer(Fleet &fleet, Door door) : fleet_(fleet), door_(std::move(door))
{
    require_free(door_.address);
    char name[256] = "";
    gethostname(name, sizeof name - 1);
    ours_ = {door_.certificate.empty() ? "http" : "https", name, door_.proxy};

    lws_set_log_level(0, nullptr);
    lws_context_creation_info info{};
    info.iface = door_.address.host.c_str();
    info.port = door_.address.port;
    info.protocols = protocols;
    info.user = this;
    info.options =
        LWS_SERVER_OPTION_EXPLICIT_VHOSTS | (door_.address.ipv6 ? 0 : LWS_SERVER_OPTION_DISABLE_IPV6);
    if (!door_.certificate.empty()) {
        info.options |= LWS_SERVER_OPTION_DO_SSL_GLOBAL_INIT;
        info.ssl_cert_filepath = door_.certificate.c_str();
        info.ssl_private_key_filepath = door_.key.c_str();
        info.alpn = "http/1.1"; /* files are written whole, which HTTP/2 does not take */
    }
    info.fd_limit_per_thread = most_descriptors;
    info.max_http_header_pool = most_descriptors; /* who has not finished his request takes nobody's place */
    info.retry_and_idle_policy = &keep_alive;
    context_ = lws_create_context(&info);
    lws_vhost *host = context_ != nullptr ? lws_create_vhost(context_, &info) : nullptr;
    if (host == nullptr) {
        lws_context_destroy(context_);
        throw std::runtime_error(
            "cannot serve at " + door_.address.url(ours_.scheme) +
            (door_.certificate.empty()
                 ? ""
                 : ": is " + door_.certificate + " a certificate, and " + door_.key + " its key?"));
    }
    door_.address.port = static_cast<uint16_t>(lws_get_vhost_listen_port(host));
    fleet_.open([this] { wake(); });
}

WebServer::~WebServer()
{
    fleet_.close();
    lws_context_destroy(context_);
}

void WebServer::run()
{
    WebCallbacks::LinkTimer timer;
    timer.server = this;
    WebCallbacks::schedule(timer);
    while (!stopping_ && lws_service(context_, 0) >= 0) {
    }
    lws_sul_schedule(context_, 0, &timer.list, nullptr, LWS_SET_TIMER_USEC_CANCEL);
}

void WebServer::stop()
{
    stopping_ = true;
    wake();
}

void WebServer::wake()
{
    lws_cancel_service(context_);
}

std::string WebServer::url() const
{
    const std::string page =
        door_.proxy.empty() ? reachable(door_.address).url(ours_.scheme) : door_.proxy + "/";
    return page + "?token=" + door_.token;
}

bool WebServer::has_token(lws *connection) const
{
    const std::string text = argument(connection, "token=");
    const std::string &token = door_.token;
    return text.size() == token.size() && sodium_memcmp(text.data(), token.data(), token.size()) == 0;
}

/* nullptr: it asks for one that is not of this console. */
Robot *WebServer::robot_of(lws *connection)
{
    return fleet_.find(argument(connection, "robot="));
}

WebServer::Connection WebServer::new_connection(lws *connection, Robot &robot)
{
    const uint64_t page = ++pages_;
    const Desk::Tell tell = {
        [this, page](std::string message) {
            if (Client *client = client_of(page)) {
                client->answer(std::move(message));
            }
        },
        [this, page](std::shared_ptr<const OpenRecording> recording, const std::string &name) {
            if (Client *client = client_of(page)) {
                client->show(std::move(recording), name);
            }
        }};
    Client client(
        robot.board(), robot.commander().operator_name(),
        [&robot, page](const std::vector<std::string> &words) { return robot.commander().send(page, words); },
        {[&robot] { return robot.desk().recorder(); },
         [&robot, tell](const PageMessage &message) { return robot.desk().ask(message, tell); }},
        {robot.name(), [this] { return fleet_.told(); },
         [this, &robot, page] { return fleet_.stop_all(page, robot); }});
    return {std::move(client), page, peer_of(connection), {}};
}

/* nullptr: the page has been left. */
Client *WebServer::client_of(uint64_t page)
{
    const auto found = std::find_if(connections_.begin(), connections_.end(),
                                    [&](const auto &entry) { return entry.second.page == page; });
    return found == connections_.end() ? nullptr : &found->second.client;
}

bool WebServer::accepts(lws *connection) const
{
    return has_token(connection) && has_room_for(connection) &&
           origin_is_ours(header(connection, WSI_TOKEN_ORIGIN), header(connection, WSI_TOKEN_HOST), ours_);
}

bool WebServer::has_room_for(lws *connection) const
{
    const std::string peer = peer_of(connection);
    const auto of_peer = std::count_if(connections_.begin(), connections_.end(),
                                       [&](const auto &entry) { return entry.second.peer == peer; });
    return connections_.size() < most_pages && static_cast<size_t>(of_peer) < most_pages_of_a_peer;
}

void WebServer::came(lws *connection)
{
    const auto who = antechamber_.enter(connection, peer_of(connection), Antechamber::Clock::now());
    if (who) {
        lws_set_timeout(static_cast<lws *>(*who), PENDING_TIMEOUT_USER_REASON_BASE, LWS_TO_KILL_ASYNC);
    }
}

void WebServer::end_overdue()
{
    for (void *who : antechamber_.overdue(Antechamber::Clock::now())) {
        antechamber_.leave(who);
        lws_set_timeout(static_cast<lws *>(who), PENDING_TIMEOUT_USER_REASON_BASE, LWS_TO_KILL_ASYNC);
    }
}

int WebServer::send_next(lws *connection)
{
    const auto found = connections_.find(connection);
    if (found == connections_.end()) {
        return 0;
    }
    const auto message = found->second.client.next(Board::Clock::now());
    if (!message) {
        return 0;
    }
    std::vector<unsigned char> buffer(LWS_PRE + message->size());
    std::memcpy(buffer.data() + LWS_PRE, message->data(), message->size());
    if (lws_write(connection, buffer.data() + LWS_PRE, message->size(), LWS_WRITE_TEXT) < 0) {
        return -1;
    }
    lws_callback_on_writable(connection);
    return 0;
}

int WebServer::send_file(lws *connection)
{
    for (Robot &robot : fleet_.robots()) {
        if (robot.desk().downloads().has(connection)) {
            return robot.desk().downloads().send_next(connection);
        }
    }
    return 0;
}

void WebServer::left(lws *connection)
{
    antechamber_.leave(connection);
    for (Robot &robot : fleet_.robots()) {
        robot.desk().downloads().left(connection);
    }
}

void WebServer::woken()
{
    for (Robot &robot : fleet_.robots()) {
        robot.desk().hand_out();
    }
    offer_all();
}

void WebServer::offer_all()
{
    for (const auto &entry : connections_) {
        lws_callback_on_writable(entry.first);
    }
}

void WebServer::links_due()
{
    for (auto &entry : connections_) {
        entry.second.client.link_due();
    }
    offer_all();
    end_overdue();
}

} // namespace console
