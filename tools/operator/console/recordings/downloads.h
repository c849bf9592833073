/* Files on their way to browsers, piece by piece: a large one holds up nobody, and one that a browser no
 * longer takes ends by the library's time-out. The serving thread only.
 *
 *   downloads.expect(connection, ticket);            when it is asked for
 *   downloads.found(ticket, wanted, content);        later; or missing(ticket, status, words)
 *   return downloads.send_next(connection);          when the connection takes more
 *   downloads.left(connection);                      when it is gone */
#ifndef CONSOLE_DOWNLOADS_H
#define CONSOLE_DOWNLOADS_H

#include <cstdint>
#include <string>
#include <unordered_map>

#include "operator/console/recordings/archive.h"

struct lws;

namespace console
{

class Downloads
{
  public:
    /* At the same time. */
    static constexpr size_t most = 16;

    bool has_room() const
    {
        return under_way_.size() < most;
    }
    bool has(lws *connection) const
    {
        return under_way_.count(connection) > 0;
    }
    /* A number by which what comes of it is told. */
    uint64_t expect(lws *connection);

    void found(uint64_t ticket, const Wanted &wanted, Content content);
    void missing(uint64_t ticket, unsigned status, const std::string &words);

    /* 0, or -1: the connection is to be closed. Those that nothing is expected by: 0. */
    int send_next(lws *connection);
    void left(lws *connection);

  private:
    struct UnderWay {
        uint64_t ticket = 0;
        unsigned status = 0; /* 0: what comes of it is not known yet */
        std::string name;
        const char *type = "";
        Content content;
        uint64_t sent = 0;
        bool begun = false;
    };

    UnderWay *of(uint64_t ticket);
    int begin(lws *connection, UnderWay &download);
    int send_piece(lws *connection, UnderWay &download);

    uint64_t tickets_ = 0;
    std::unordered_map<lws *, UnderWay> under_way_;
};

} // namespace console

#endif
