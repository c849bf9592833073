// --poses: what is said of one scan.
#include "lab/replay/poses_file.h"

#include <string>

#include <gtest/gtest.h>

#include "files.hpp"

namespace
{

TEST(PosesFile, TheMapAndTheFaultOfTheWheelsEndTheObject)
{
    const files::TemporaryFolder folder;
    const std::string path = folder.path() / "poses.jsonl";
    ale::PosesFile file(path);
    ale_estimate_t estimate{};
    estimate.maps = 1;
    file.put(estimate);
    estimate.map_id = 3;
    estimate.maps = 2;
    estimate.wheel_fault = ALE_WHEELS_STALLED;
    file.put(estimate);
    file.close();
    const std::string text = files::content(path);
    const std::string fine = R"("predicted":false,"map_id":0,"maps":1,"wheel_fault":"fine"})";
    const std::string stalled = R"("predicted":false,"map_id":3,"maps":2,"wheel_fault":"stalled"})";
    EXPECT_NE(text.find(fine + "\n{"), std::string::npos) << text;
    EXPECT_EQ(text.substr(text.size() - stalled.size() - 1), stalled + "\n") << text;
}

} // namespace
