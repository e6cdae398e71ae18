// Chorus.cs against a stream at args[0]: people by slot, rotations that fit the joints, and stale when it ends.
using System;
using System.Collections.Generic;
using System.Threading;
using Chorus;

static class ChorusTest {
  static int failures;

  static void Check(bool holds, string what) {
    if (holds) return;
    ++failures;
    Console.WriteLine("FAILED: " + what);
  }

  static double Apart(Vec a, Vec b) { return (a - b).Length; }

  static Person TPose(double yaw) {
    var person = new Person { Slot = 0 };
    var turn = new Quat { Y = Math.Sin(yaw / 2), W = Math.Cos(yaw / 2) };
    Action<string, double, double, double> put = (name, x, y, z) =>
      person[name] = new Joint { State = JointState.Tracked, Position = turn * new Vec(x, y, z) };
    put("SpineBase", 0, 1, 0); put("SpineMid", 0, 1.2, 0); put("SpineShoulder", 0, 1.45, 0); put("Neck", 0, 1.5, 0); put("Head", 0, 1.7, 0);
    foreach (double side in new[] { -1.0, 1.0 }) {
      string name = side < 0 ? "Left" : "Right";
      put("Shoulder" + name, side * .2, 1.45, 0); put("Elbow" + name, side * .5, 1.45, 0); put("Wrist" + name, side * .75, 1.45, 0);
      put("HandTip" + name, side * .9, 1.45, 0); put("Thumb" + name, side * .8, 1.45, .05);
      put("Hip" + name, side * .1, 1, 0); put("Knee" + name, side * .1, .5, 0); put("Ankle" + name, side * .1, .1, 0);
      put("Foot" + name, side * .1, .1 - .12 * Math.Sin(.436), .12 * Math.Cos(.436));
    }
    return person;
  }

  static void TestRest() {
    foreach (double yaw in new[] { 0, .5, Math.PI / 2, Math.PI, -2 }) {
      Humanoid pose = Humanoid.Of(TPose(yaw));
      var expected = new Quat { Y = Math.Sin(yaw / 2), W = Math.Cos(yaw / 2) };
      foreach (Bone bone in Enum.GetValues(typeof(Bone))) {
        Check(pose.Knows(bone), bone + " is known");
        foreach (Vec axis in new[] { new Vec(1, 0, 0), new Vec(0, 1, 0), new Vec(0, 0, 1) })
          Check(Apart(pose.RotationOf(bone) * axis, expected * axis) < 1e-6, "T-pose turned by " + yaw + ": " + bone);
      }
    }
    Person bent = TPose(0);
    bent["WristLeft"] = new Joint { State = JointState.Tracked, Position = new Vec(-.5, 1.45, .25) };  // The forearm forwards.
    Humanoid arm = Humanoid.Of(bent);
    Check(Apart(arm.RotationOf(Bone.LeftUpperArm) * new Vec(0, 0, 1), new Vec(0, 0, 1)) < 1e-6, "an elbow bent forwards does not twist the upper arm");
    Check(Apart(arm.RotationOf(Bone.LeftLowerArm) * new Vec(-1, 0, 0), new Vec(0, 0, 1)) < 1e-6, "the forearm points forwards");
    Check(Humanoid.Of(null) == null && Humanoid.Of(new Person()) == null, "nothing known, nothing drawn");
    Person hidden = TPose(0);
    hidden["ElbowRight"] = new Joint();
    Check(!Humanoid.Of(hidden).Knows(Bone.RightUpperArm), "an arm without an elbow is not known");
  }

  static void TestJson() {
    var read = (Dictionary<string, object>)Json.Parse("{\"a\": [1, -2.5e1, \"x\\n\\u00e4\\\"\"], \"b\": {}, \"c\": null, \"d\": [] }");
    var a = (List<object>)read["a"];
    Check((double)a[1] == -25 && (string)a[2] == "x\n\u00e4\"" && read["c"] == null, "JSON");
    foreach (string bad in new[] { "", "{", "[1 2]", "{\"a\" 1}", "\"", "{} x", "[1,", "tru", "{\"a\":}" }) {
      bool refused = false;
      try { Json.Parse(bad); } catch (FormatException) { refused = true; }
      Check(refused, "no JSON: " + bad);
    }
    Check(Json.Whole("18446744073709551615") == ulong.MaxValue, "an id of 64 bits");
  }

  static void CheckFits(Person person, Humanoid pose, Bone bone, Vec rest, string from, string to) {
    if (!pose.Knows(bone)) return;
    Vec way = (person[to].Position - person[from].Position).Unit;
    Check(Apart(pose.RotationOf(bone) * rest, way) < 1e-6, bone + " lies along " + from + "-" + to);
  }

  static int TestStream(string url) {
    int frames = 0, poses = 0;
    ulong last = 0;
    using (var tracker = new Tracker(url)) {
      Check(tracker.IsStale && tracker.Newest == null, "stale before the first frame");
      tracker.Start();
      DateTime patience = DateTime.UtcNow.AddSeconds(20);
      while (frames < 20 && DateTime.UtcNow < patience) {
        Frame frame = tracker.Newest;
        if (frame == null || frame.Sequence == last) { Thread.Sleep(5); continue; }
        Check(frame.Sequence > last, "sequences grow");
        last = frame.Sequence;
        ++frames;
        Person person = frame.BySlot(0);
        Humanoid pose = Humanoid.Of(person);
        if (pose == null) continue;
        ++poses;
        Check(pose.HipsPosition.Y > .3 && pose.HipsPosition.Y < 1.5, "hips above the floor");
        CheckFits(person, pose, Bone.LeftUpperArm, new Vec(-1, 0, 0), "ShoulderLeft", "ElbowLeft");
        CheckFits(person, pose, Bone.RightLowerArm, new Vec(1, 0, 0), "ElbowRight", "WristRight");
        CheckFits(person, pose, Bone.LeftLowerLeg, new Vec(0, -1, 0), "KneeLeft", "AnkleLeft");
        CheckFits(person, pose, Bone.Chest, new Vec(0, 1, 0), "SpineMid", "SpineShoulder");
      }
      Check(frame20(frames), "20 frames within 20 s, not " + frames + " " + tracker.Error);
      Check(poses > 10, "poses of the person in slot 0: " + poses);
      Console.WriteLine("streamed");  // The test now ends the stream.
      patience = DateTime.UtcNow.AddSeconds(20);
      while (!tracker.IsStale && DateTime.UtcNow < patience) Thread.Sleep(20);
      Check(tracker.IsStale && tracker.Newest == null, "stale once the stream has ended");
      while (tracker.Error == "" && DateTime.UtcNow < patience) Thread.Sleep(20);
      Check(tracker.Error != "", "and says why");
    }
    return frames;
  }
  static bool frame20(int frames) { return frames >= 20; }

  static int Main(string[] args) {
    TestRest();
    TestJson();
    TestStream(args[0]);
    Console.WriteLine(failures == 0 ? "ok" : failures + " failures");
    return failures == 0 ? 0 : 1;
  }
}
