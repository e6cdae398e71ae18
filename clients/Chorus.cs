// A client of Chorus in one file without dependencies, for Unity and every other C# (7 or later, .NET Standard 2.0).
//
//   var tracker = new Chorus.Tracker("http://127.0.0.1:8080/") { MaxRate = 60 };
//   tracker.Start();
//   ...
//   Chorus.Frame frame = tracker.Newest;                  // null: none yet, or stale
//   Chorus.Person first = frame?.BySlot(0);               // slots are the numbers that every output uses
//   Chorus.Humanoid pose = Chorus.Humanoid.Of(first);     // rotations for Unity's HumanBodyBones
//
// Places are in metres and in Unity's axes: y up, z forward, left-handed (the tracker's z is turned round).
// A person's rotations are those of a rig that rests in T-pose and looks along +z.
// In Unity, put ChorusTracker on one object and a ChorusAvatar on each humanoid (at the end of this file).
using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Net;
using System.Text;
using System.Threading;

namespace Chorus {

public struct Vec {
  public double X, Y, Z;
  public Vec(double x, double y, double z) { X = x; Y = y; Z = z; }
  public static Vec operator +(Vec a, Vec b) { return new Vec(a.X + b.X, a.Y + b.Y, a.Z + b.Z); }
  public static Vec operator -(Vec a, Vec b) { return new Vec(a.X - b.X, a.Y - b.Y, a.Z - b.Z); }
  public static Vec operator *(double s, Vec a) { return new Vec(s * a.X, s * a.Y, s * a.Z); }
  public double Dot(Vec b) { return X * b.X + Y * b.Y + Z * b.Z; }
  public Vec Cross(Vec b) { return new Vec(Y * b.Z - Z * b.Y, Z * b.X - X * b.Z, X * b.Y - Y * b.X); }
  public double Length { get { return Math.Sqrt(Dot(this)); } }
  public Vec Unit { get { return (1 / Length) * this; } }
}

/// A rotation; the components are Unity's.
public struct Quat {
  public double X, Y, Z, W;
  public static readonly Quat Identity = new Quat { W = 1 };

  public static Vec operator *(Quat q, Vec v) {
    var u = new Vec(q.X, q.Y, q.Z);
    Vec t = 2 * u.Cross(v);
    return v + q.W * t + u.Cross(t);
  }
  public static Quat operator *(Quat a, Quat b) {
    return new Quat {
      X = a.W * b.X + a.X * b.W + a.Y * b.Z - a.Z * b.Y, Y = a.W * b.Y - a.X * b.Z + a.Y * b.W + a.Z * b.X,
      Z = a.W * b.Z + a.X * b.Y - a.Y * b.X + a.Z * b.W, W = a.W * b.W - a.X * b.X - a.Y * b.Y - a.Z * b.Z }.Unit;
  }
  public Quat Unit {
    get {
      double n = Math.Sqrt(X * X + Y * Y + Z * Z + W * W);
      return n > 1e-9 ? new Quat { X = X / n, Y = Y / n, Z = Z / n, W = W / n } : Identity;
    }
  }

  /// The shortest rotation that takes one unit vector to another.
  public static Quat FromTo(Vec from, Vec to) {
    double cosine = from.Dot(to);
    if (cosine < -1 + 1e-9) {  // Half a turn about any axis across.
      Vec axis = from.Cross(Math.Abs(from.X) < 0.9 ? new Vec(1, 0, 0) : new Vec(0, 1, 0)).Unit;
      return new Quat { X = axis.X, Y = axis.Y, Z = axis.Z, W = 0 };
    }
    Vec c = from.Cross(to);
    return new Quat { X = c.X, Y = c.Y, Z = c.Z, W = 1 + cosine }.Unit;
  }

  /// The rotation that takes one orthonormal frame to another.
  public static Quat Between(Vec[] from, Vec[] to) {
    Quat first = FromTo(from[0], to[0]);
    Vec turned = first * from[1];
    double angle = Math.Atan2(to[0].Dot(turned.Cross(to[1])), turned.Dot(to[1]));
    double s = Math.Sin(angle / 2);
    return new Quat { X = s * to[0].X, Y = s * to[0].Y, Z = s * to[0].Z, W = Math.Cos(angle / 2) } * first;
  }
}

public enum JointState { NotTracked, Inferred, Tracked }

public struct Joint {
  public Vec Position;      ///< Of no meaning if NotTracked.
  public JointState State;
  public bool IsKnown { get { return State != JointState.NotTracked; } }
}

/// Somebody at one instant.
public sealed class Person {
  public ulong Id;
  public int Slot = -1;           ///< -1: none.
  public double Sides = double.NaN;  ///< Probability that left and right are right; NaN: not known.
  public double UnseenFor;        ///< Seconds for which no sensor has seen them; 0: one does.
  readonly Dictionary<string, Joint> joints = new Dictionary<string, Joint>();

  /// "Head", "WristLeft", ...; one that the frame lacks is NotTracked.
  public Joint this[string name] {
    get { Joint joint; joints.TryGetValue(name, out joint); return joint; }
    set { joints[name] = value; }
  }

  internal static Person Of(Dictionary<string, object> body) {
    var person = new Person { Id = Json.Whole(body["bodyId"]) };
    if (body.ContainsKey("slot")) person.Slot = (int)Json.Whole(body["slot"]);
    if (body.ContainsKey("sidesConfidence")) person.Sides = Json.Number(body["sidesConfidence"]);
    if (body.ContainsKey("carriedFor")) person.UnseenFor = Json.Number(body["carriedFor"]);
    foreach (var pair in (Dictionary<string, object>)body["joints"]) {
      var said = (Dictionary<string, object>)pair.Value;
      var joint = new Joint();
      var state = (string)said["state"];
      if (said.ContainsKey("x")) {  // A ray has none.
        joint.State = state == "Tracked" ? JointState.Tracked : state == "Inferred" ? JointState.Inferred : JointState.NotTracked;
        joint.Position = new Vec(Json.Number(said["x"]), Json.Number(said["y"]), -Json.Number(said["z"]));
      }
      person.joints[pair.Key] = joint;
    }
    return person;
  }
}

/// All people at one instant.
public sealed class Frame {
  public ulong Sequence;
  public long CapturedNanoseconds;  ///< Since 1970, by the tracker's clock.
  public readonly List<Person> People = new List<Person>();

  /// Null: nobody has this slot.
  public Person BySlot(int slot) { return People.Find(person => person.Slot == slot); }

  public static Frame Parse(string json) {
    var document = (Dictionary<string, object>)Json.Parse(json);
    var frame = new Frame { Sequence = Json.Whole(document["sequence"]), CapturedNanoseconds = (long)Json.Whole(document["capturedNanoseconds"]) };
    foreach (object body in (List<object>)document["bodies"]) frame.People.Add(Person.Of((Dictionary<string, object>)body));
    return frame;
  }
}

/// Follows a tracker on a thread of its own.  Everything may be called from any thread.
public sealed class Tracker : IDisposable {
  public string Token;               ///< Where the tracker wants one: of role read.
  public double MaxRate;             ///< Frames a second, at most; 0: all.  Set it before Start().
  public double StaleAfter = 1.0;    ///< Seconds without a frame after which Newest is null.

  readonly Uri url;
  readonly object gate = new object();
  Thread thread;
  volatile bool stopping;
  HttpWebRequest request;
  Frame newest;
  DateTime arrived;
  string error = "";

  public Tracker(string url) { this.url = new Uri(url.TrimEnd('/') + "/"); }

  public void Start() {
    if (thread != null) return;
    thread = new Thread(Run) { IsBackground = true, Name = "Chorus" };
    thread.Start();
  }

  public void Dispose() {
    stopping = true;
    lock (gate) { if (request != null) request.Abort(); }
    if (thread != null) thread.Join(2000);
  }

  /// The newest frame; null before the first one and when it is stale: then show that nothing is known.
  public Frame Newest { get { lock (gate) return IsOld() ? null : newest; } }
  /// True while no frame has come for StaleAfter: nobody is where they were drawn last.
  public bool IsStale { get { lock (gate) return IsOld(); } }
  /// What is wrong with the connection, for people; empty if nothing is.
  public string Error { get { lock (gate) return error; } }

  bool IsOld() { return newest == null || (DateTime.UtcNow - arrived).TotalSeconds > StaleAfter; }

  void Run() {
    while (!stopping) {
      try {
        Follow();
        Say("the tracker has ended the stream");
      } catch (Exception failure) {  // Whatever it was: say so, and try again.
        if (!stopping) Say(failure.Message);
      }
      if (!stopping) Thread.Sleep(1000);
    }
  }

  void Say(string what) { lock (gate) error = what; }

  void Follow() {
    string query = "frame?form=pose" + (MaxRate > 0 ? "&max_rate=" + MaxRate.ToString(CultureInfo.InvariantCulture) : "");
    var asked = (HttpWebRequest)WebRequest.Create(new Uri(url, query));
    asked.Accept = "text/event-stream";
    asked.Timeout = 10000;
    asked.ReadWriteTimeout = 35000;  // The tracker says something every 15 s.
    if (!string.IsNullOrEmpty(Token)) asked.Headers["Authorization"] = "Bearer " + Token;
    lock (gate) request = asked;
    using (WebResponse answer = asked.GetResponse())
    using (var lines = new StreamReader(answer.GetResponseStream(), Encoding.UTF8)) {
      string line;
      while (!stopping && (line = lines.ReadLine()) != null) {
        if (!line.StartsWith("data: ", StringComparison.Ordinal)) continue;
        Frame frame = Frame.Parse(line.Substring(6));
        lock (gate) {
          newest = frame;
          arrived = DateTime.UtcNow;
          error = "";
        }
      }
    }
  }
}

public enum Bone {
  Hips, Spine, Chest, UpperChest, Neck, Head,
  LeftShoulder, LeftUpperArm, LeftLowerArm, LeftHand, RightShoulder, RightUpperArm, RightLowerArm, RightHand,
  LeftUpperLeg, LeftLowerLeg, LeftFoot, LeftToes, RightUpperLeg, RightLowerLeg, RightFoot, RightToes
}

/// A person as rotations of a rig that rests in T-pose: names as in Unity's HumanBodyBones.
///
/// Every bone points exactly along its joints.  Its twist comes from the hips and the shoulders for the trunk, from the
/// plane of a bent elbow or knee for the limbs; a straight limb turns the shortest way from the trunk.
public sealed class Humanoid {
  public static readonly int BoneCount = Enum.GetValues(typeof(Bone)).Length;

  public Vec HipsPosition;
  readonly Quat[] rotations = new Quat[BoneCount];  ///< In the world.
  readonly bool[] known = new bool[BoneCount];

  /// In the world; a bone that is not known has its parent's.
  public Quat RotationOf(Bone bone) { return rotations[(int)bone]; }
  public bool Knows(Bone bone) { return known[(int)bone]; }

  static readonly Vec Up = new Vec(0, 1, 0), Left = new Vec(-1, 0, 0), Forward = new Vec(0, 0, 1);
  const double BentSine = 0.3;     // About 17 deg: with less, a joint has no plane to trust.
  const double FootFalls = 0.436;  // 25 deg: so the line from ankle to foot points down in a flat foot.

  static readonly Bone[] Parents = {
    Bone.Hips, Bone.Hips, Bone.Spine, Bone.Chest, Bone.UpperChest, Bone.Neck,
    Bone.UpperChest, Bone.LeftShoulder, Bone.LeftUpperArm, Bone.LeftLowerArm,
    Bone.UpperChest, Bone.RightShoulder, Bone.RightUpperArm, Bone.RightLowerArm,
    Bone.Hips, Bone.LeftUpperLeg, Bone.LeftLowerLeg, Bone.LeftFoot,
    Bone.Hips, Bone.RightUpperLeg, Bone.RightLowerLeg, Bone.RightFoot };

  /// Null if the person is null, or if hips or facing are not known: then nothing can be drawn.
  public static Humanoid Of(Person person) {
    if (person == null) return null;
    var rig = new Humanoid();
    return rig.AddTrunk(person) ? rig.AddRest(person) : null;
  }

  static Vec? Way(Person person, string from, string to) {
    Joint a = person[from], b = person[to];
    if (!a.IsKnown || !b.IsKnown) return null;
    Vec way = b.Position - a.Position;
    return way.Length > 1e-4 ? way.Unit : (Vec?)null;
  }

  void Set(Bone bone, Quat rotation) { rotations[(int)bone] = rotation; known[(int)bone] = true; }
  void Follow(Bone bone) { rotations[(int)bone] = RotationOf(Parents[(int)bone]); }
  void FollowKnown(Bone bone) { Follow(bone); known[(int)bone] = Knows(Parents[(int)bone]); }

  /// Exact for `along`, as close as possible for `aside`; if that gives no plane, the shortest turn from the parent.
  void Turn(Bone bone, Vec restAlong, Vec restAside, Vec? along, Vec? aside, double least = 0.17) {
    if (along == null) { Follow(bone); return; }
    if (aside != null && along.Value.Cross(aside.Value).Length > least) {
      Set(bone, Quat.Between(FrameOf(restAlong, restAside), FrameOf(along.Value, aside.Value)));
      return;
    }
    Quat parent = RotationOf(Parents[(int)bone]);
    Set(bone, Quat.FromTo(parent * restAlong, along.Value) * parent);
  }

  static Vec[] FrameOf(Vec along, Vec aside) {
    Vec normal = along.Cross(aside).Unit;
    return new[] { along, normal.Cross(along), normal };
  }

  bool AddTrunk(Person person) {
    Vec? hips = Way(person, "HipRight", "HipLeft"), shoulders = Way(person, "ShoulderRight", "ShoulderLeft");
    Vec? left = hips ?? shoulders;
    if (left == null || !person["SpineBase"].IsKnown) return false;
    HipsPosition = person["SpineBase"].Position;
    for (int i = 0; i < BoneCount; ++i) rotations[i] = Quat.Identity;
    Vec up = Way(person, "SpineBase", "SpineMid") ?? Way(person, "SpineBase", "SpineShoulder") ?? Up;
    Turn(Bone.Hips, Left, Up, left, up);
    Vec across = shoulders ?? left.Value;
    Turn(Bone.Spine, Up, Left, Way(person, "SpineBase", "SpineMid"), left.Value + across);
    Turn(Bone.Chest, Up, Left, Way(person, "SpineMid", "SpineShoulder"), across);
    FollowKnown(Bone.UpperChest);
    Turn(Bone.Neck, Up, Left, Way(person, "SpineShoulder", "Neck"), across);
    Turn(Bone.Head, Up, Left, Way(person, "Neck", "Head"), across);
    return true;
  }

  Humanoid AddRest(Person person) {
    foreach (string side in new[] { "Left", "Right" }) {
      bool isLeft = side == "Left";
      Vec outwards = isLeft ? Left : new Vec(1, 0, 0);
      // Elbows bend forwards, knees backwards; the axis of the bend is upper x lower.
      FollowKnown(Named(side, "Shoulder"));
      AddLimb(person, Named(side, "UpperArm"), Named(side, "LowerArm"), new[] { "Shoulder" + side, "Elbow" + side, "Wrist" + side }, outwards, outwards.Cross(Forward));
      AddLimb(person, Named(side, "UpperLeg"), Named(side, "LowerLeg"), new[] { "Hip" + side, "Knee" + side, "Ankle" + side }, new Vec(0, -1, 0), new Vec(0, -1, 0).Cross(new Vec(0, 0, -1)));
      Vec? hand = Way(person, "Wrist" + side, "HandTip" + side) ?? Way(person, "Wrist" + side, "Hand" + side);
      Turn(Named(side, "Hand"), outwards, Forward, hand, Way(person, "Wrist" + side, "Thumb" + side));
      Vec flat = Math.Cos(FootFalls) * Forward + (-Math.Sin(FootFalls)) * Up;
      Turn(Named(side, "Foot"), flat, Up, Way(person, "Ankle" + side, "Foot" + side), Way(person, "Ankle" + side, "Knee" + side));
      FollowKnown(Named(side, "Toes"));
    }
    return this;
  }

  static Bone Named(string side, string part) { return (Bone)Enum.Parse(typeof(Bone), side + part); }

  void AddLimb(Person person, Bone upper, Bone lower, string[] joints, Vec restAlong, Vec restHinge) {
    Vec? first = Way(person, joints[0], joints[1]), second = Way(person, joints[1], joints[2]);
    Vec? hinge = null;
    if (first != null && second != null) {
      Vec axis = first.Value.Cross(second.Value);
      if (axis.Length > BentSine) hinge = axis.Unit;
    }
    Turn(upper, restAlong, restHinge, first, hinge);
    Turn(lower, restAlong, restHinge, second, hinge);
  }
}

/// Enough of JSON (RFC 8259) to read frames: objects, arrays, strings, numbers (double), booleans, null.
public static class Json {
  public static object Parse(string text) {
    int at = 0;
    object value = Value(text, ref at, 0);
    Space(text, ref at);
    if (at != text.Length) throw Wrong(at);
    return value;
  }

  /// A number, also one that is a string because it has too many digits for a double.
  public static ulong Whole(object value) {
    return value is string ? ulong.Parse((string)value, CultureInfo.InvariantCulture) : (ulong)(double)value;
  }
  public static double Number(object value) {
    return value is string ? double.Parse((string)value, CultureInfo.InvariantCulture) : (double)value;
  }

  static FormatException Wrong(int at) { return new FormatException("no JSON at character " + at); }
  static void Space(string text, ref int at) { while (at < text.Length && " \t\r\n".IndexOf(text[at]) >= 0) ++at; }

  static object Value(string text, ref int at, int depth) {
    Space(text, ref at);
    if (at >= text.Length || depth > 32) throw Wrong(at);
    switch (text[at]) {
      case '{': return Members(text, ref at, depth);
      case '[': return Items(text, ref at, depth);
      case '"': return Text(text, ref at);
      case 't': return Word(text, ref at, "true", true);
      case 'f': return Word(text, ref at, "false", false);
      case 'n': return Word(text, ref at, "null", null);
    }
    int begin = at;
    while (at < text.Length && "+-0123456789.eE".IndexOf(text[at]) >= 0) ++at;
    double number;
    if (!double.TryParse(text.Substring(begin, at - begin), NumberStyles.Float, CultureInfo.InvariantCulture, out number)) throw Wrong(begin);
    return number;
  }

  static object Word(string text, ref int at, string word, object value) {
    if (string.CompareOrdinal(text, at, word, 0, word.Length) != 0) throw Wrong(at);
    at += word.Length;
    return value;
  }

  /// Whether another item follows; takes the comma, or the end.
  static bool Next(string text, ref int at, char end, ref bool first) {
    Space(text, ref at);
    if (at >= text.Length) throw Wrong(at);
    bool over = text[at] == end;
    if (!over && !first && text[at] != ',') throw Wrong(at);
    if (over || !first) ++at;
    first = false;
    return !over;
  }

  static Dictionary<string, object> Members(string text, ref int at, int depth) {
    var members = new Dictionary<string, object>();
    bool first = true;
    ++at;
    while (Next(text, ref at, '}', ref first)) {
      Space(text, ref at);
      string key = Text(text, ref at);
      Space(text, ref at);
      if (at >= text.Length || text[at++] != ':') throw Wrong(at);
      members[key] = Value(text, ref at, depth + 1);
    }
    return members;
  }

  static List<object> Items(string text, ref int at, int depth) {
    var items = new List<object>();
    bool first = true;
    ++at;
    while (Next(text, ref at, ']', ref first)) items.Add(Value(text, ref at, depth + 1));
    return items;
  }

  static string Text(string text, ref int at) {
    if (at >= text.Length || text[at] != '"') throw Wrong(at);
    var said = new StringBuilder();
    for (++at; at < text.Length && text[at] != '"'; ++at) {
      if (text[at] != '\\') { said.Append(text[at]); continue; }
      if (++at >= text.Length) break;
      int escape = "bfnrt".IndexOf(text[at]);
      if (escape >= 0) said.Append("\b\f\n\r\t"[escape]);
      else if (text[at] != 'u') said.Append(text[at]);
      else if (at + 4 < text.Length) {
        said.Append((char)ushort.Parse(text.Substring(at + 1, 4), NumberStyles.HexNumber, CultureInfo.InvariantCulture));
        at += 4;
      }
    }
    if (at >= text.Length) throw Wrong(at);
    ++at;
    return said.ToString();
  }
}

}  // namespace Chorus

#if UNITY_5_3_OR_NEWER
/// On one object of the scene: follows the tracker for all avatars.
public class ChorusTracker : UnityEngine.MonoBehaviour {
  public string url = "http://127.0.0.1:8080/";
  public string token = "";
  public float maxRate = 60;
  public Chorus.Tracker Tracker { get; private set; }

  void OnEnable() {
    Tracker = new Chorus.Tracker(url) { Token = token, MaxRate = maxRate };
    Tracker.Start();
  }
  void OnDisable() { Tracker.Dispose(); }
}

/// On a humanoid that stands in T-pose and looks along its own +z when the scene begins: moves it as the person in `slot`
/// moves.  While the frame is stale, or nobody has the slot, it is not drawn.
public class ChorusAvatar : UnityEngine.MonoBehaviour {
  public ChorusTracker source;
  public int slot = 0;

  UnityEngine.Animator animator;
  UnityEngine.Renderer[] renderers;
  readonly UnityEngine.Quaternion[] rest = new UnityEngine.Quaternion[Chorus.Humanoid.BoneCount];

  UnityEngine.Transform TransformOf(Chorus.Bone bone) {
    return animator.GetBoneTransform((UnityEngine.HumanBodyBones)System.Enum.Parse(typeof(UnityEngine.HumanBodyBones), bone.ToString()));
  }

  void Start() {
    animator = GetComponent<UnityEngine.Animator>();
    renderers = GetComponentsInChildren<UnityEngine.Renderer>();
    foreach (Chorus.Bone bone in System.Enum.GetValues(typeof(Chorus.Bone))) {
      UnityEngine.Transform part = TransformOf(bone);
      if (part != null) rest[(int)bone] = UnityEngine.Quaternion.Inverse(transform.rotation) * part.rotation;
    }
  }

  void LateUpdate() {
    Chorus.Frame frame = source.Tracker.Newest;
    Chorus.Humanoid pose = Chorus.Humanoid.Of(frame == null ? null : frame.BySlot(slot));
    foreach (UnityEngine.Renderer one in renderers) one.enabled = pose != null;
    if (pose == null) return;
    foreach (Chorus.Bone bone in System.Enum.GetValues(typeof(Chorus.Bone))) {  // Parents come before children.
      UnityEngine.Transform part = TransformOf(bone);
      if (part == null) continue;
      Chorus.Quat q = pose.RotationOf(bone);
      part.rotation = transform.rotation * new UnityEngine.Quaternion((float)q.X, (float)q.Y, (float)q.Z, (float)q.W) * rest[(int)bone];
      if (bone == Chorus.Bone.Hips)
        part.position = transform.TransformPoint(new UnityEngine.Vector3((float)pose.HipsPosition.X, (float)pose.HipsPosition.Y, (float)pose.HipsPosition.Z));
    }
  }
}
#endif
