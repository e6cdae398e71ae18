// As much of Unity's interface as Chorus.cs uses, so that a compiler can check that part.
namespace UnityEngine {
public struct Vector3 { public Vector3(float x, float y, float z) {} }
public struct Quaternion {
  public Quaternion(float x, float y, float z, float w) {}
  public static Quaternion operator *(Quaternion a, Quaternion b) { return a; }
  public static Quaternion Inverse(Quaternion a) { return a; }
}
public class Object {}
public class Component : Object {
  public Transform transform { get { return null; } }
  public T GetComponent<T>() { return default(T); }
  public T[] GetComponentsInChildren<T>() { return null; }
}
public class Transform : Component {
  public Quaternion rotation { get; set; }
  public Vector3 position { get; set; }
  public Vector3 TransformPoint(Vector3 p) { return p; }
}
public class Renderer : Component { public bool enabled { get; set; } }
public class Animator : Component { public Transform GetBoneTransform(HumanBodyBones bone) { return null; } }
public class MonoBehaviour : Component {}
public enum HumanBodyBones { Hips, Head }
}
