/* The page over HTTP or HTTPS, and a robot's board over a web socket to every browser that asks.
 *
 *   WebServer server(fleet, door);   (throws std::runtime_error)
 *   server.run();                    (until another thread stops it)
 *
 * Page and web socket are for those who have the token in the address (?token=...). Which robot they are of
 * stands there, too (&robot=...); without, of the first one.
 * One thread runs the server; wake() and stop() may be called from any. */
#ifndef CONSOLE_WEB_SERVER_H
#define CONSOLE_WEB_SERVER_H

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <unordered_map>

#include "operator/console/antechamber.h"
#include "operator/console/client.h"
#include "operator/console/fleet.h"
#include "operator/console/http_address.h"

struct lws;
struct lws_context;

namespace console
{

/* Where and for whom the page is served. */
struct Door {
    HttpAddress address;
    std::string token;
    std::string certificate; /* PEM files; both empty: without TLS */
    std::string key;
    std::string proxy; /* as in Ours */
};

class WebServer
{
  public:
    WebServer(Fleet &fleet, Door door);
    ~WebServer();
    WebServer(const WebServer &) = delete;
    WebServer &operator=(const WebServer &) = delete;

    /* Where it listens: with the port that was found when any was asked for. */
    const HttpAddress &address() const
    {
        return door_.address;
    }

    /* What a person opens. */
    std::string url() const;

    void run();
    void stop();
    void wake();

  private:
    friend struct WebCallbacks;

    /* More pages than look at one robot, and so many of one peer that another still comes in. */
    static constexpr size_t most_pages = 64;
    static constexpr size_t most_pages_of_a_peer = 48;
    /* Pages, those who wait, and some that are on their way out: keeps a flood from eating the machine. */
    static constexpr unsigned most_descriptors = 256;

    struct Connection {
        Client client;
        uint64_t page;
        std::string peer;
        std::string heard; /* of a message that has not come whole yet */
    };

    Client *client_of(uint64_t page);
    bool has_token(lws *connection) const;
    Robot *robot_of(lws *connection);
    bool accepts(lws *connection) const;
    bool has_room_for(lws *connection) const;
    void came(lws *connection);
    void end_overdue();
    Connection new_connection(lws *connection, Robot &robot);
    /* 0, or -1: the connection takes no more, and is to be closed. */
    int send_next(lws *connection);
    int send_file(lws *connection);
    void left(lws *connection);
    void woken();
    void offer_all();
    void links_due();

    Fleet &fleet_;
    Door door_;
    Ours ours_;
    uint64_t pages_ = 0;
    Antechamber antechamber_;
    lws_context *context_ = nullptr;
    std::unordered_map<lws *, Connection> connections_;
    std::atomic<bool> stopping_{false};
};

} // namespace console

#endif
