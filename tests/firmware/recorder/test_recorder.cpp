#include <gtest/gtest.h>

#include <chrono>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "comes_true.hpp"
#include "drivers/store/chunks.hpp"
#include "files.hpp"
#include "firmware/surroundings.hpp"

extern "C" {
#include "recorder/recorder.h"
}

namespace
{

namespace fs = std::filesystem;

/* Chunks of a recording as letters: b bytes, o odometry, d decision, s stages, c command, k correction. */
std::string letters(const fs::path &path)
{
    std::string text;
    uint64_t bad = 0;
    for (const Chunk &chunk : chunks_of(files::content(path), &bad)) {
        text += "?bbockCds"[chunk.kind];
    }
    EXPECT_EQ(bad, 0u);
    return text;
}

class Recorder : public surroundings::WithPort
{
  protected:
    void SetUp() override
    {
        config = ale_config_default();
        std::strncpy(config.recorder_folder, folder.path().c_str(), sizeof config.recorder_folder - 1);
        config.recorder_megabytes = 1;
        recorder = ale_recorder_start(&config);
        ASSERT_NE(recorder, nullptr);
    }
    void TearDown() override
    {
        ale_recorder_stop(recorder);
    }

    void bytes(const std::string &text)
    {
        ale_recorder_bytes(recorder, false, reinterpret_cast<const uint8_t *>(text.data()),
                           static_cast<uint32_t>(text.size()), 1);
    }
    void odometry(uint32_t number)
    {
        const ale_odometry_t sample{};
        ale_recorder_odometry(recorder, number, &sample);
    }
    void result(uint32_t number, uint32_t odometry_taken)
    {
        auto made = std::make_unique<ale_result_t>();
        made->answered = number;
        made->odometry_taken = odometry_taken;
        ale_recorder_result(recorder, made.get());
    }
    std::vector<fs::path> written() const
    {
        std::vector<fs::path> found;
        for (const auto &entry : fs::directory_iterator(folder.path())) {
            if (entry.path().extension() == ".scip") {
                found.push_back(entry.path());
            }
        }
        return found;
    }
    /* Triggers a recording and waits until it is on the disk. */
    void record(ale_record_reason_t reason)
    {
        const uint32_t before = ale_recorder_written(recorder);
        ale_recorder_trigger(recorder, reason);
        ASSERT_TRUE(comes_true([&] { return ale_recorder_written(recorder) != before; }));
    }
    void leave(const std::string &name) const
    {
        std::ofstream(folder / name) << "a recording";
    }
    bool is_there(const std::string &name) const
    {
        return fs::exists(folder / name);
    }
    /* Asks for a recording and waits for it. */
    std::string recorded()
    {
        const uint32_t before = ale_recorder_written(recorder);
        ale_recorder_trigger(recorder, ALE_RECORD_COMMAND);
        EXPECT_TRUE(comes_true([&] { return ale_recorder_written(recorder) != before; }));
        EXPECT_EQ(written().size(), 1u);
        return letters(written().at(0));
    }

    const files::TemporaryFolder folder;
    ale_config_t config{};
    ale_recorder_t *recorder = nullptr;
};

TEST_F(Recorder, OdometryLiesBeforeTheScanThatKnewItWhenItWasUsed)
{
    odometry(0);
    odometry(1);
    bytes("scan 0");
    ale_recorder_scan(recorder, 0);
    odometry(2);
    result(0, 1); /* sample 1 came too late for scan 0, sample 2 later still */
    bytes("scan 1");
    ale_recorder_scan(recorder, 1);
    result(1, 3);
    EXPECT_EQ(recorded(), "Cobdsoobds");
}

TEST_F(Recorder, TheConfigurationTellsThePresetOfTheScannerThatWasFound)
{
    EXPECT_EQ(recorded(), "C");
    EXPECT_NE(files::content(written().at(0)).find("\nmodel = \n"), std::string::npos);
    fs::remove(written().at(0));
    ale_recorder_preset(recorder, std::string("utm-30lx").append(ALE_PRESET_NAME, '\0').c_str());
    EXPECT_EQ(recorded(), "C");
    EXPECT_NE(files::content(written().at(0)).find("\nmodel = utm-30lx\n"), std::string::npos);
}

TEST_F(Recorder, OdometryThatCameWhileTwoScansWereAnsweredInOneGoLiesBehindBoth)
{
    for (uint32_t scan = 0; scan < 3; scan++) {
        bytes("scan");
        ale_recorder_scan(recorder, scan);
    }
    odometry(0);
    result(0, 0);
    result(1, 0);
    result(2, 1);
    EXPECT_EQ(recorded(), "Cbdsbdsobds");
}

TEST_F(Recorder, AScanWithoutRoomForItsResultKeepsItsPlace)
{
    bytes("scan 0");
    ale_recorder_scan(recorder, 0);
    bytes("scan 1");
    ale_recorder_scan(recorder, 1);
    result(1, 0);
    EXPECT_EQ(recorded(), "Cbbds");
}

TEST_F(Recorder, CommandsAndCorrectionsLieBeforeTheScanThatFollowsThem)
{
    bytes("scan 0");
    ale_recorder_scan(recorder, 0);
    odometry(0);
    ale_recorder_command(recorder, 1, "reset");
    ale_recorder_correction(recorder, 1, 0, ale_pose_t{});
    result(0, 0);
    EXPECT_EQ(recorded(), "Cckbds"); /* no scan has known the sample so far */
}

TEST_F(Recorder, BytesThatMakeNoScanAreKeptAfterAWhile)
{
    bytes(std::string(1500, '?'));
    odometry(0);
    std::this_thread::sleep_for(std::chrono::milliseconds(1200));
    EXPECT_EQ(recorded(), "Cobbb");
}

TEST_F(Recorder, WritersNeverWaitAndWhatIsRefusedIsCounted)
{
    std::thread acquire([this] {
        for (uint32_t k = 0; k < 20000; k++) {
            bytes(std::string(400, 'x'));
            ale_recorder_scan(recorder, k);
        }
    });
    for (uint32_t k = 0; k < 20000; k++) {
        odometry(k);
        result(k, k);
    }
    acquire.join();
    EXPECT_GT(ale_recorder_refused(recorder), 0u);
    std::this_thread::sleep_for(std::chrono::milliseconds(1200));
    EXPECT_GT(recorded().size(), 1000u) << "a ring full of intact chunks";
}

TEST_F(Recorder, AskedRecordingsTakeNoFaultsPlace)
{
    for (int k = 0; k < ALE_FLIGHTS_OF_FAULTS; k++) {
        leave("flight-0000000" + std::to_string(k) + "-20260101T000000.000Z-fault.scip");
    }
    for (int k = 0; k < 12; k++) {
        record(ALE_RECORD_COMMAND);
    }
    int faults = 0;
    int asked = 0;
    for (const fs::path &path : written()) {
        faults += path.string().find("-fault.scip") != std::string::npos;
        asked += path.string().find("-command.scip") != std::string::npos;
    }
    EXPECT_EQ(faults, ALE_FLIGHTS_OF_FAULTS);
    EXPECT_EQ(asked, ALE_FLIGHTS_ASKED);
}

TEST_F(Recorder, AClockThatIsSetBackTakesNoNewRecordingAway)
{
    leave("flight-20991231T235959.000Z-command.scip"); /* without a number */
    for (int k = 1; k < ALE_FLIGHTS_ASKED; k++) {
        leave("flight-0000000" + std::to_string(k) + "-20990101T000000.000Z-command.scip");
    }
    record(ALE_RECORD_COMMAND);
    record(ALE_RECORD_COMMAND);
    EXPECT_EQ(written().size(), static_cast<size_t>(ALE_FLIGHTS_ASKED));
    EXPECT_FALSE(is_there("flight-20991231T235959.000Z-command.scip"));
    EXPECT_FALSE(is_there("flight-00000001-20990101T000000.000Z-command.scip"));
    EXPECT_TRUE(is_there("flight-00000002-20990101T000000.000Z-command.scip"));
}

TEST_F(Recorder, WithoutARecorderNothingHappens)
{
    ale_recorder_scan(nullptr, 0);
    ale_recorder_trigger(nullptr, ALE_RECORD_FAULT);
    ale_recorder_stop(nullptr);
    EXPECT_EQ(ale_recorder_written(nullptr), 0u);
}

} // namespace
