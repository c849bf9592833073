// firmware/mapping/persistence: a disk that takes no map, and takes one again, is said once each.
#include <fcntl.h>
#include <unistd.h>

#include <memory>
#include <string>

#include "comes_true.hpp"
#include "files.hpp"
#include "firmware/surroundings.hpp"

extern "C" {
#include "mapping/persistence.h"
}

namespace
{

// Standard error in a file, for as long as it is there.
class Said
{
  public:
    explicit Said(std::filesystem::path path) : path_(std::move(path)), before_(dup(STDERR_FILENO))
    {
        const int file = open(path_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
        dup2(file, STDERR_FILENO);
        close(file);
    }
    ~Said()
    {
        dup2(before_, STDERR_FILENO);
        close(before_);
    }
    Said(const Said &) = delete;
    Said &operator=(const Said &) = delete;

    int count(const std::string &words) const
    {
        const std::string text = files::content(path_);
        int found = 0;
        for (size_t at = text.find(words); at != std::string::npos; at = text.find(words, at + 1)) {
            found++;
        }
        return found;
    }

  private:
    std::filesystem::path path_;
    int before_;
};

class Persistence : public surroundings::WithPort
{
};

TEST_F(Persistence, AMapThatIsNotKeptIsSaidOnceAndOnceThatItIsAgain)
{
    const files::TemporaryFolder folder;
    const Said said(folder / "said");
    const std::string path = (folder / "late/kept.map").string();
    const auto map = std::make_unique<ale_map_t>();
    map->line_count = 1;
    map->line[0].end = {3000000, 0};
    map->line[0].seen = 20;
    const ale_pose_t pose{};
    ale_persistence_t *persistence = ale_persistence_start(path.c_str());
    ASSERT_NE(persistence, nullptr);
    const auto offered_until = [&](const char *words) {
        return comes_true([&] {
            ale_persistence_offer(persistence, map.get(), &pose);
            return said.count(words) > 0;
        });
    };
    EXPECT_TRUE(offered_until("map and pose are not kept: "));
    for (int k = 0; k < 20; k++) {
        ale_persistence_offer(persistence, map.get(), &pose);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    std::filesystem::create_directory(folder / "late");
    EXPECT_TRUE(offered_until("map and pose are kept again"));
    ale_persistence_stop(persistence);
    EXPECT_EQ(said.count("not kept"), 1);
    EXPECT_EQ(said.count("kept again"), 1);
    EXPECT_TRUE(std::filesystem::exists(path));
}

} // namespace
