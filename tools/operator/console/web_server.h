/* The page over HTTP, and the board over a web socket to every browser that asks.
 *
 *   WebServer server(board, commander, parse_http_address("127.0.0.1:8080"), token);   (throws
 * std::runtime_error) server.run();                                                    (until another thread
 * stops it)
 *
 * With a token, page and web socket are for those who have it in the address (?token=...).
 * One thread runs the server; wake() and stop() may be called from any. */
#ifndef CONSOLE_WEB_SERVER_H
#define CONSOLE_WEB_SERVER_H

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <unordered_map>

#include "operator/console/board.h"
#include "operator/console/client.h"
#include "operator/console/commander.h"
#include "operator/console/http_address.h"

struct lws;
struct lws_context;

namespace console
{

class WebServer
{
  public:
    /* token empty: none is asked for. */
    WebServer(Board &board, Commander &commander, const HttpAddress &address, std::string token);
    ~WebServer();
    WebServer(const WebServer &) = delete;
    WebServer &operator=(const WebServer &) = delete;

    /* Where it listens: with the port that was found when any was asked for. */
    const HttpAddress &address() const
    {
        return address_;
    }

    /* What a person opens. */
    std::string url() const;

    void run();
    void stop();
    void wake();

  private:
    friend struct WebCallbacks;

    /* More browsers than look at one robot; keeps a flood from eating the machine. */
    static constexpr unsigned most_connections = 64;

    struct Connection {
        Client client;
        std::string heard; /* of a message that has not come whole yet */
    };

    bool has_token(lws *connection) const;
    bool accepts(lws *connection) const;
    Client new_client();
    void send_next(lws *connection);
    void offer_all();
    void links_due();

    Board &board_;
    Commander &commander_;
    HttpAddress address_;
    std::string token_;
    uint64_t pages_ = 0;
    std::string machine_name_;
    lws_context *context_ = nullptr;
    std::unordered_map<lws *, Connection> connections_;
    std::atomic<bool> stopping_{false};
};

} // namespace console

#endif
