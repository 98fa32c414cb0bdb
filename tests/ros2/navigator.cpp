// A robot with the action /navigate_to_pose and a battery, with ROS 2 over Fast DDS, as Nav2 and a base would
// have them. For examples/10_patrol.
//
//     ros2_navigator [DOMAIN [SECONDS]]
//
// It drives straight to its goal, and charges at (0, 0). Each metre costs 12.5 % of the battery; below 20 % it
// creeps. Its second goal is aborted, as by something in the way. It ends after that time, or when a controller
// has come and gone, and prints a summary: "goals 8, succeeded 5, aborted 1, given up 2, below 20 %: 1, charged 1,
// under way 0". A goal is given up if it is cancelled, or another one comes.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "fast_action.hpp"

namespace {

struct NavigateRequest {
  static constexpr const char* name = "nav2_msgs::action::dds_::NavigateToPose_SendGoal_Request_";
  std::uint64_t client = 0;
  std::int64_t sequence = 0;
  fast::Uuid uuid{};
  fast::PoseStamped pose;
  std::string behaviour_tree;
  template <class Archive>
  void fields(Archive& all) {
    all(client, sequence, uuid);
    pose.header.fields(all);
    for (double& number : pose.pose) all(number);
    all(behaviour_tree);
  }
};
struct NavigateResponse : fast::SendGoalResponse {
  static constexpr const char* name = "nav2_msgs::action::dds_::NavigateToPose_SendGoal_Response_";
};
struct ResultRequest : fast::GetResultRequest {
  static constexpr const char* name = "nav2_msgs::action::dds_::NavigateToPose_GetResult_Request_";
};
struct ResultResponse {
  static constexpr const char* name = "nav2_msgs::action::dds_::NavigateToPose_GetResult_Response_";
  std::uint64_t client = 0;
  std::int64_t sequence = 0;
  std::int8_t status = 0;
  std::uint16_t error_code = 0;
  std::string error_msg;
  template <class Archive>
  void fields(Archive& all) {
    all(client, sequence, status, error_code, error_msg);
  }
};
struct NavigateFeedback {
  static constexpr const char* name = "nav2_msgs::action::dds_::NavigateToPose_FeedbackMessage_";
  fast::Uuid uuid{};
  fast::PoseStamped current;
  std::int32_t navigation_s = 0, remaining_s = 0;
  std::uint32_t navigation_ns = 0, remaining_ns = 0;
  std::int16_t recoveries = 0;
  float distance_remaining = 0;
  template <class Archive>
  void fields(Archive& all) {
    all(uuid);
    current.header.fields(all);
    for (double& number : current.pose) all(number);
    all(navigation_s, navigation_ns, remaining_s, remaining_ns, recoveries, distance_remaining);
  }
};
struct BatteryState {
  static constexpr const char* name = "sensor_msgs::msg::dds_::BatteryState_";
  fast::Header header;
  float voltage = 24, temperature = NAN, current = NAN, charge = NAN, capacity = NAN, design_capacity = NAN,
        percentage = 1;
  std::uint8_t status = 0, health = 0, technology = 0;
  bool present = true;
  std::vector<float> cell_voltage, cell_temperature;
  std::string location, serial_number;
  template <class Archive>
  void fields(Archive& all) {
    header.fields(all);
    all(voltage, temperature, current, charge, capacity, design_capacity, percentage, status, health,
        technology, present, cell_voltage, cell_temperature, location, serial_number);
  }
};

constexpr double step_s = 0.02, low = 0.2;
constexpr std::int8_t executing = 2, canceling = 3, succeeded = 4, canceled = 5, aborted = 6, unknown = 0;

/// One goal at a time, as Nav2 has it: a new one takes the place of the one before, which is aborted.
class Navigator {
 public:
  explicit Navigator(fast::Peer& peer)
      : goals_(peer.reader<NavigateRequest>("rq" + action + "send_goalRequest", false, id(1))),
        answers_(peer.writer<NavigateResponse>("rr" + action + "send_goalReply", true, id(1))),
        questions_(peer.reader<ResultRequest>("rq" + action + "get_resultRequest", false, id(2))),
        results_(peer.writer<ResultResponse>("rr" + action + "get_resultReply", true, id(2))),
        cancels_(peer.reader<fast::CancelGoalRequest>("rq" + action + "cancel_goalRequest", false, id(3))),
        cancelled_(peer.writer<fast::CancelGoalResponse>("rr" + action + "cancel_goalReply", true, id(3))),
        feedback_(peer.writer<NavigateFeedback>("rt" + action + "feedback")),
        states_(peer.writer<fast::StatusArray>("rt" + action + "status", true, "", /*transient_local=*/true)),
        battery_(peer.writer<BatteryState>("rt/battery_state", /*reliable=*/false)) {}

  [[nodiscard]] bool has_client() const { return fast::Peer::is_matched(*goals_); }

  void step() {
    while (const auto wish = fast::Peer::take<fast::CancelGoalRequest>(*cancels_)) cancel(*wish);
    while (const auto order = fast::Peer::take<NavigateRequest>(*goals_)) begin(*order);
    while (const auto question = fast::Peer::take<ResultRequest>(*questions_)) ask(*question);
    if (status_ == executing) drive();
    charge();
    if (++steps_ % 5 != 0) return;
    BatteryState battery;
    battery.percentage = static_cast<float>(charge_);
    battery_->write(&battery);
    if (status_ != executing) return;
    NavigateFeedback feedback;
    feedback.uuid = goal_;
    feedback.distance_remaining = static_cast<float>(distance());
    feedback_->write(&feedback);
  }

  void report() const {
    std::printf(
        "goals %d, succeeded %d, aborted %d, given up %d, below 20 %%: %d, charged %d, under way %d\n",
        ordered_, succeeded_, aborted_, given_up_, given_up_low_, charged_, status_ == executing ? 1 : 0);
  }

 private:
  void begin(const NavigateRequest& order) {
    give_up(aborted);
    goal_ = order.uuid;
    goal_x_ = order.pose.pose[0];
    goal_y_ = order.pose.pose[1];
    NavigateResponse answer;
    answer.client = order.client;
    answer.sequence = order.sequence;
    answer.accepted = order.pose.header.frame_id == "map";
    answers_->write(&answer);
    ++ordered_;
    if (!answer.accepted) return;
    status_ = executing;
    publish();
    if (ordered_ != 2) return;
    ++aborted_;
    end(aborted);
  }
  void cancel(const fast::CancelGoalRequest& wish) {
    const bool known = status_ == executing && (wish.uuid == goal_ || wish.uuid == fast::Uuid{});
    fast::CancelGoalResponse answer{wish.client, wish.sequence, static_cast<std::int8_t>(known ? 0 : 2),
                                    goal_};
    cancelled_->write(&answer);
    if (!known) return;
    give_up(canceled);
  }
  void give_up(std::int8_t status) {
    if (status_ != executing) return;
    ++given_up_;
    if (charge_ < low) ++given_up_low_;
    if (status == canceled) {
      status_ = canceling;
      publish();
    }
    end(status);
  }
  /// The result of a goal under way is given at its end.
  void ask(const ResultRequest& question) {
    if (question.uuid == goal_ && status_ == executing) {
      asked_ = question;
      return;
    }
    const auto result = ends_.find(question.uuid);
    answer(question, result == ends_.end() ? unknown : result->second);
  }
  void answer(const ResultRequest& question, std::int8_t status) {
    ResultResponse response{question.client, question.sequence, status};
    results_->write(&response);
  }
  void end(std::int8_t status) {
    status_ = status;
    ends_[goal_] = status;
    publish();
    if (asked_) answer(*asked_, status);
    asked_.reset();
  }
  void publish() {
    fast::StatusArray all;
    all.goals.push_back({goal_, 0, 0, status_});
    states_->write(&all);
  }

  [[nodiscard]] double distance() const { return std::hypot(goal_x_ - x_, goal_y_ - y_); }
  void drive() {
    const double far = distance(), step = std::min(far, (charge_ < low ? 1 : 4) * step_s);
    if (far > 0) {
      x_ += step * (goal_x_ - x_) / far;
      y_ += step * (goal_y_ - y_) / far;
    }
    charge_ = std::max(0.0, charge_ - 0.125 * step);
    if (distance() > 0.01) return;
    ++succeeded_;
    end(succeeded);
  }
  void charge() {
    if (status_ == executing || ordered_ == 0 || std::hypot(x_, y_) > 0.02) return;
    if (charge_ < low) ++charged_;
    charge_ = std::min(1.0, std::max(low, charge_ + step_s));
  }
  static std::string id(int number) { return "serviceid=01.0f." + std::to_string(number) + ";"; }

  const std::string action = "/navigate_to_pose/_action/";
  eprosima::fastdds::dds::DataReader* goals_;
  eprosima::fastdds::dds::DataWriter* answers_;
  eprosima::fastdds::dds::DataReader* questions_;
  eprosima::fastdds::dds::DataWriter* results_;
  eprosima::fastdds::dds::DataReader* cancels_;
  eprosima::fastdds::dds::DataWriter* cancelled_;
  eprosima::fastdds::dds::DataWriter* feedback_;
  eprosima::fastdds::dds::DataWriter* states_;
  eprosima::fastdds::dds::DataWriter* battery_;

  fast::Uuid goal_{};
  std::int8_t status_ = unknown;
  std::optional<ResultRequest> asked_;
  std::map<fast::Uuid, std::int8_t> ends_;
  double goal_x_ = 0, goal_y_ = 0, x_ = 0, y_ = 0, charge_ = 1;
  int steps_ = 0, ordered_ = 0, succeeded_ = 0, aborted_ = 0, given_up_ = 0, given_up_low_ = 0, charged_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  const auto domain = static_cast<std::uint32_t>(argc > 1 ? std::atoi(argv[1]) : 0);
  const double seconds = argc > 2 ? std::atof(argv[2]) : 1e9;
  fast::Peer peer(domain);
  Navigator navigator(peer);
  bool met = false;
  const auto start = std::chrono::steady_clock::now();
  for (auto next = start; next - start < std::chrono::duration<double>(seconds);) {
    const bool here = navigator.has_client();
    if (met && !here) break;
    met = met || here;
    navigator.step();
    std::this_thread::sleep_until(next += std::chrono::milliseconds(20));
  }
  navigator.report();
}
