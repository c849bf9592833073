/* ale-grid: the robot's map as an occupancy grid, for programs that are not of this tree's C++. */
#include <cstdint>
#include <cstdio>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/command_line/command_line.h"
#include "common/feed/checks.h"
#include "common/feed/map_parts.h"
#include "common/feed/map_pieces.h"
#include "common/feed/occupancy.h"
#include "operator/grid/event_stream.h"

namespace
{

constexpr char usage[] =
    "usage: ale-grid [--every SECONDS] < EVENTS > GRIDS\n"
    "The robot's map as an occupancy grid: its walls, and what its scans left free. EVENTS are messages of "
    "the\n"
    "robot as lcm-logger writes them, from a log or as they come.\n"
    "  --every SECONDS  at most one grid in so many seconds of the robot's time, and one in the end "
    "(default 2)\n"
    "  --help, --version\n"
    "Of each grid a line of JSON: utime (us), x, y (m: lower left corner in the map), cell (m), columns, "
    "rows;\n"
    "then columns * rows bytes, the row of the least y first: 0 free, 100 occupied, 255 unknown.\n"
    "Exit status: 0 EVENTS ended, 1 failed, 2 wrong use.\n";

constexpr int64_t latest_us = 4000000000000000; /* 2096: seconds of 32 bits, as others have them */

uint8_t byte_of(ale::OccupancyGrid::Cell cell)
{
    constexpr uint8_t unknown = 255;
    constexpr uint8_t occupied = 100;
    return cell == ale::OccupancyGrid::Cell::unknown ? unknown
           : cell == ale::OccupancyGrid::Cell::free  ? uint8_t{0}
                                                     : occupied;
}

void write(const ale::OccupancyGrid &grid, int64_t utime)
{
    constexpr double metre = 1e-6;
    std::vector<uint8_t> cells;
    cells.reserve(static_cast<size_t>(grid.columns()) * static_cast<size_t>(grid.rows()));
    for (int32_t row = 0; row < grid.rows(); row++) {
        for (int32_t column = 0; column < grid.columns(); column++) {
            cells.push_back(byte_of(grid.at(column, row)));
        }
    }
    std::printf(
        "{\"utime\": %lld, \"x\": %.3f, \"y\": %.3f, \"cell\": %.3f, \"columns\": %d, \"rows\": %d}\n",
        static_cast<long long>(utime), static_cast<double>(grid.left_um()) * metre,
        static_cast<double>(grid.bottom_um()) * metre, static_cast<double>(grid.cell_um()) * metre,
        grid.columns(), grid.rows());
    if (std::fwrite(cells.data(), 1, cells.size(), stdout) != cells.size() || std::fflush(stdout) != 0) {
        throw std::runtime_error("standard output takes no more");
    }
}

/* Takes messages, and writes a grid when it is time for one. */
class Surveyor
{
  public:
    explicit Surveyor(double every_s) : every_us_(static_cast<int64_t>(every_s * 1e6))
    {
        take<ale::scan_t>("ALE_SCAN", [this](const ale::scan_t &scan) { occupancy_.take(scan); });
        take<ale::tracking_t>("ALE_TRACKING",
                              [this](const ale::tracking_t &tracking) { occupancy_.take(tracking); });
        take<ale::graph_t>("ALE_GRAPH", [this](const ale::graph_t &graph) { occupancy_.take(graph); });
        take<ale::map_pieces_t>("ALE_MAP_PIECES",
                                [this](const ale::map_pieces_t &pieces) { pieces_.add(pieces); });
        take<ale::map_t>("ALE_MAP", [this](const ale::map_t &part) {
            if (parts_.add(part)) {
                occupancy_.take(parts_.whole(), pieces_);
            }
        });
        take<ale::pose_t>("ALE_POSE", [this](const ale::pose_t &pose) {
            feed::require(pose.utime >= 0 && pose.utime < latest_us, "a time out of this world");
            newest_utime_ = pose.utime;
            occupancy_.take(pose);
        });
    }

    /* What is no message of the robot is left out and counted. */
    void take(const grid::Event &event)
    {
        const auto taker = takers_.find(event.channel);
        if (taker == takers_.end()) {
            return;
        }
        try {
            taker->second(event.data);
        } catch (const std::exception &) {
            malformed_++;
        }
    }

    /* A clock that steps back is that of another start of the robot. */
    bool is_due() const
    {
        return newest_utime_ && (!written_utime_ || *newest_utime_ < *written_utime_ ||
                                 *newest_utime_ - *written_utime_ >= every_us_);
    }

    /* What is too large to be drawn is told, and begun anew. */
    void write_what_is_new()
    {
        if (!newest_utime_ || !occupancy_.has_changed()) {
            return;
        }
        written_utime_ = newest_utime_;
        std::optional<ale::OccupancyGrid> grid;
        try {
            grid = occupancy_.grid();
        } catch (const std::runtime_error &error) {
            std::fprintf(stderr, "ale-grid: %s\n", error.what());
            return;
        }
        write(*grid, *newest_utime_);
    }

    uint64_t malformed() const
    {
        return malformed_;
    }

  private:
    template <class Message>
    void take(const std::string &channel, std::function<void(const Message &)> handler)
    {
        takers_[channel] = [handler](const std::vector<uint8_t> &data) {
            Message message;
            if (message.decode(data.data(), 0, static_cast<int>(data.size())) < 0) {
                throw std::runtime_error("truncated, or of another type");
            }
            feed::check(message);
            handler(message);
        };
    }

    int64_t every_us_;
    std::map<std::string, std::function<void(const std::vector<uint8_t> &)>> takers_;
    feed::MapParts parts_;
    feed::MapPieces pieces_;
    feed::Occupancy occupancy_;
    std::optional<int64_t> newest_utime_; /* that a pose has told */
    std::optional<int64_t> written_utime_;
    uint64_t malformed_ = 0;
};

void survey(double every_s)
{
    Surveyor surveyor(every_s);
    grid::EventStream events(stdin);
    grid::Event event;
    while (events.next(event)) {
        surveyor.take(event);
        if (surveyor.is_due()) {
            surveyor.write_what_is_new();
        }
    }
    surveyor.write_what_is_new();
    if (surveyor.malformed() > 0) {
        std::fprintf(stderr, "ale-grid: %llu messages were malformed\n",
                     static_cast<unsigned long long>(surveyor.malformed()));
    }
}

} // namespace

int main(int argc, char **argv)
{
    double every_s = 2;
    cli::CommandLine line("ale-grid", usage);
    line.number("every", every_s, 0.1, 3600.0);
    return line.run(argc, argv, [&] { survey(every_s); });
}
