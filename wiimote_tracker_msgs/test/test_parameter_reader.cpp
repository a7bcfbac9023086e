// What a user gets to read when a parameter is missing, wrong, out of range or misspelt.
#include "refusal_of.h"
#include "wiimote_tracker_msgs/parameter_reader.h"

#include <gtest/gtest.h>
#include <ros/ros.h>

namespace wiimote_tracker {
namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(ParameterReader, ReadsWhatIsSet) {
  ParameterReader reader(ros::NodeHandle("~good"));
  EXPECT_EQ(2.5, reader.required<double>("side", "the side length [m]"));
  EXPECT_EQ(3, reader.bounded("count", 1, 0, 5));
  EXPECT_EQ("square", reader.choice("name", "circle", {"circle", "square"}));
  EXPECT_EQ((std::vector<std::string>{"a", "b"}),
            reader.optional("list", std::vector<std::string>{}));
  EXPECT_TRUE(reader.optional("flag", false));
  EXPECT_NO_THROW(reader.refuseUnknown());
}

TEST(ParameterReader, DefaultsApplyWhenAbsent) {
  ParameterReader reader(ros::NodeHandle("~good"));
  EXPECT_EQ(7.0, reader.bounded("absent", 7.0, 0.0, 10.0));
  EXPECT_EQ("circle", reader.choice("absent", "circle", {"circle", "square"}));
}

TEST(ParameterReader, ErrorsNameTheFullKey) {
  ParameterReader reader(ros::NodeHandle("~good"));
  const std::string ns = ros::this_node::getName() + "/good/";
  EXPECT_TRUE(contains(refusalOf([&] { reader.required<double>("absent", "the side [m]"); }),
                       ns + "absent: the side [m]"));
  EXPECT_TRUE(contains(refusalOf([&] { reader.optional<int>("name", 1); }), ns + "name"));
  EXPECT_TRUE(contains(refusalOf([&] { reader.bounded("side", 1.0, 3.0, 9.0); }),
                       ns + "side is 2.5, but must be within 3 and 9"));
  EXPECT_TRUE(contains(refusalOf([&] {
                         reader.choice("name", "circle", {"circle", "line"});
                       }),
                       "must be one of: circle, line"));
}

TEST(ParameterReader, UnknownKeyIsRefusedByName) {
  ParameterReader reader(ros::NodeHandle("~typo"));
  reader.required<double>("side", "the side length [m]");
  const std::string error = refusalOf([&] { reader.refuseUnknown(); });
  EXPECT_TRUE(contains(error, ros::this_node::getName() + "/typo/sied")) << error;
  EXPECT_FALSE(contains(error, "/typo/side")) << error;
  const std::string nested =
      refusalOf([] { ParameterReader(ros::NodeHandle("~nested")).refuseUnknown(); });
  EXPECT_TRUE(contains(nested, "/nested/group/inner")) << nested;
}

/// {side: 2.5, whole: 3, name: square, list: [a, b], flag: true, group: {inner: 1}}
ParameterTree tree() {
  XmlRpc::XmlRpcValue values;
  values["side"] = 2.5;
  values["whole"] = 3;
  values["name"] = "square";
  values["list"][0] = "a";
  values["list"][1] = "b";
  values["flag"] = true;
  values["group"]["inner"] = 1;
  return {"file.yaml", values};
}

TEST(ParameterReaderOfAFile, ReadsWhatTheServerWouldGive) {
  ParameterReader reader(tree());
  EXPECT_EQ(2.5, reader.required<double>("side", "the side length [m]"));
  EXPECT_EQ(3.0, reader.bounded("whole", 1.0, 0.0, 5.0)) << "a whole number is a number";
  EXPECT_EQ(3, reader.bounded("whole", 1, 0, 5));
  EXPECT_EQ("square", reader.choice("name", "circle", {"circle", "square"}));
  EXPECT_EQ((std::vector<std::string>{"a", "b"}),
            reader.optional("list", std::vector<std::string>{}));
  EXPECT_TRUE(reader.optional("flag", false));
  EXPECT_EQ(7.0, reader.bounded("absent", 7.0, 0.0, 10.0));
  EXPECT_EQ(7, reader.bounded("side/absent", 7, 0, 10));
  const std::string error = refusalOf([&] { reader.refuseUnknown(); });
  EXPECT_TRUE(contains(error, "unknown parameter file.yaml/group/inner:")) << error;
  EXPECT_EQ(1, reader.bounded("group/inner", 0, 0, 5));
  EXPECT_NO_THROW(reader.refuseUnknown());
}

TEST(ParameterReaderOfAFile, AValueIsNoGroup) {
  ParameterTree changed = tree();
  changed.set("group/text", "words");
  EXPECT_EQ("words", ParameterReader(changed).optional<std::string>("group/text", ""));
  try {
    changed.set("side/file", "words");
    ADD_FAILURE() << "side is a number";
  } catch (const Error& e) {
    EXPECT_TRUE(contains(e.what(), "file.yaml/side/file cannot be set")) << e.what();
  }
}

// roscpp would round it.
TEST(ParameterReader, AFractionIsNoWholeNumber) {
  ros::NodeHandle nh("~fraction");
  nh.setParam("count", 2.5);
  ParameterReader reader(nh);
  EXPECT_TRUE(contains(
      refusalOf([&] { reader.bounded("count", 1, 0, 5); }),
      nh.resolveName("count") + " has the wrong type: expected a whole number, but it is 2.5"));
  nh.setParam("count", 2);
  EXPECT_EQ(2, ParameterReader(nh).bounded("count", 1, 0, 5));
}

TEST(ParameterReaderOfAFile, ErrorsNameFileAndKey) {
  ParameterReader reader(tree());
  EXPECT_TRUE(contains(refusalOf([&] { reader.optional<int>("side", 1); }),
                       "file.yaml/side has the wrong type: expected a whole number"));
  EXPECT_TRUE(contains(refusalOf([&] { reader.optional("list", std::vector<double>{}); }),
                       "file.yaml/list has the wrong type"));
  EXPECT_TRUE(contains(refusalOf([&] { reader.optional<double>("group", 1.0); }),
                       "file.yaml/group has the wrong type: expected a number, but it is a group"));
  EXPECT_TRUE(contains(refusalOf([&] { reader.required<double>("absent", "the side [m]"); }),
                       "set file.yaml/absent: the side [m]"));
  // What YAML makes of off.
  EXPECT_TRUE(contains(refusalOf([&] {
                         reader.choice("flag", "on", {"on", "off"});
                       }),
                       "expected a text (in quotes), but it is true"));
}

TEST(ParameterReaderOfAFile, ErrorsShowAText) {
  ParameterTree changed = tree();
  changed.set("latency", "1e-2");  // which PyYAML takes for a text
  changed.set("long", std::string(1000, 'x'));
  ParameterReader reader(changed);
  EXPECT_TRUE(contains(refusalOf([&] { reader.optional<double>("latency", 1.0); }),
                       "file.yaml/latency has the wrong type: expected a number, but it is the "
                       "text '1e-2'"));
  const std::string shortened = refusalOf([&] { reader.optional<double>("long", 1.0); });
  EXPECT_TRUE(contains(shortened, "file.yaml/long has the wrong type")) << shortened;
  EXPECT_GT(200u, shortened.size());
}

}  // namespace
}  // namespace wiimote_tracker
