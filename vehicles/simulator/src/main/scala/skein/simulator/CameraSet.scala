package skein.simulator

import skein.units.{Quaternion, Vector3}

/** The cameras that vehicles of a kind carry by default.
  *
  * @param aliases numbers that older clients use, and other names of these cameras
  */
final private[simulator] case class CameraSet(places: Map[String, Camera], aliases: Map[String, String])

private[simulator] object CameraSet:

  /** The cameras of AirSim's multirotor. AirSim's positions are in a binary asset that is not available,
    * except for the 25 cm between front left and front right; so these positions are ours.
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

  /** The cameras of AirSim's car (`CarPawn`), moved half a metre up and outwards. The simulator's car is
    * longer and higher than AirSim's buggy, and the original positions would be inside it.
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
    Camera(position, Quaternion.of(0, math.toRadians(pitchDeg), math.toRadians(yawDeg)))
