// lib/graph/walls/line_ids: a wall keeps its id from one rebuilt map to the next.
#include <gtest/gtest.h>

#include <memory>
#include <set>

#include "graph/walls/line_ids.h"

namespace
{

ale_map_line_t line(double x1_m, double y1_m, double x2_m, double y2_m)
{
    const auto um = [](double m) { return static_cast<int32_t>(m * 1e6); };
    ale_map_line_t out{};
    out.start = {um(x1_m), um(y1_m)};
    out.end = {um(x2_m), um(y2_m)};
    return out;
}

std::vector<uint32_t> ids_of(ale::LineIds &ids, const std::vector<ale_map_line_t> &lines)
{
    auto map = std::make_unique<ale_map_t>();
    for (const ale_map_line_t &l : lines) {
        map->line[map->line_count++] = l;
    }
    ids.assign(map.get());
    std::vector<uint32_t> out;
    for (int k = 0; k < map->line_count; k++) {
        out.push_back(map->line[k].id);
    }
    return out;
}

TEST(LineIds, WallsKeepTheirIdsInAnyOrder)
{
    ale::LineIds ids;
    const auto first = ids_of(ids, {line(0, 0, 4, 0), line(4, 0, 4, 3), line(4, 3, 0, 3)});
    EXPECT_EQ(std::set<uint32_t>(first.begin(), first.end()).size(), 3U);
    const auto second = ids_of(ids, {line(4, 3.04, 1, 3), line(0, 0.03, 5, 0), line(4.02, 0, 4, 2)});
    EXPECT_EQ(second, (std::vector<uint32_t>{first[2], first[0], first[1]}));
}

TEST(LineIds, OfTwoPartsTheLongerKeepsTheId)
{
    ale::LineIds ids;
    const auto whole = ids_of(ids, {line(0, 0, 4, 0)});
    const auto parts = ids_of(ids, {line(0, 0, 1, 0), line(1.5, 0, 4, 0)});
    EXPECT_EQ(parts[1], whole[0]);
    EXPECT_NE(parts[0], whole[0]);
}

TEST(LineIds, OtherWallsGetNewIds)
{
    ale::LineIds ids;
    const auto first = ids_of(ids, {line(0, 0, 4, 0)});
    const std::vector<ale_map_line_t> others = {line(4, 0, 0, 0),     // the back of it
                                                line(0, 0.2, 4, 0.2), // beside it
                                                line(5, 0, 6, 0),     // further along
                                                line(0, 0, 4, 0.8)};  // turned
    const auto second = ids_of(ids, others);
    for (const uint32_t id : second) {
        EXPECT_NE(id, first[0]);
    }
    EXPECT_EQ(std::set<uint32_t>(second.begin(), second.end()).size(), others.size());
}

} // namespace
