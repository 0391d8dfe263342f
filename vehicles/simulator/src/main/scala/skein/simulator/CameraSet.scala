package skein.simulator

import skein.units.{Quaternion, Vector3}

/** The cameras that vehicles of a kind carry without being told to.
  *
  * @param aliases numbers that older clients use, and other names of the same cameras
  */
final private[simulator] case class CameraSet(places: Map[String, Camera], aliases: Map[String, String])

private[simulator] object CameraSet:

  /** Those of AirSim's multirotor. Its places are in a binary file that nobody can read here, but for the 25
    * cm between the front left and the front right one; so these are ours.
    */
  val OfMultirotor: CameraSet = CameraSet(
    Map(
      "front_center"  -> looking(Vector3(0.25, 0, 0), yawDeg = 0),
      "front_right"   -> looking(Vector3(0.25, 0.125, 0), yawDeg = 0),
      "front_left"    -> looking(Vector3(0.25, -0.125, 0), yawDeg = 0),
      "bottom_center" -> looking(Vector3(0, 0, 0.05), pitchDeg = -90),
      "back_center"   -> looking(Vector3(-0.25, 0, 0), yawDeg = 180)
    ),
    Map(
      ""    -> "front_center",
      "fpv" -> "front_center",
      "0"   -> "front_center",
      "1"   -> "front_right",
      "2"   -> "front_left",
      "3"   -> "bottom_center",
      "4"   -> "back_center"
    )
  )

  /** Those of AirSim's car (`CarPawn`), and half a metre higher and farther to the front and back: our car is
    * longer and higher than its buggy, and they would look at it from inside.
    */
  val OfCar: CameraSet = CameraSet(
    Map(
      "front_center" -> looking(Vector3(2.5, 0, -1.5)),
      "front_right"  -> looking(Vector3(2.5, 0.125, -1.5)),
      "front_left"   -> looking(Vector3(2.5, -0.125, -1.5)),
      "fpv"          -> looking(Vector3(0, -0.25, -1.75)),
      "back_center"  -> looking(Vector3(-2.5, 0, -1.5), yawDeg = 180)
    ),
    Map(
      ""  -> "front_center",
      "0" -> "front_center",
      "1" -> "front_right",
      "2" -> "front_left",
      "3" -> "fpv",
      "4" -> "back_center"
    )
  )

  private def looking(position: Vector3, yawDeg: Double = 0, pitchDeg: Double = 0): Camera =
    val yaw   = math.toRadians(yawDeg) / 2
    val pitch = math.toRadians(pitchDeg) / 2
    Camera(
      position,
      Quaternion(StrictMath.cos(yaw), 0, 0, StrictMath.sin(yaw)) * Quaternion(
        StrictMath.cos(pitch),
        0,
        StrictMath.sin(pitch),
        0
      )
    )
