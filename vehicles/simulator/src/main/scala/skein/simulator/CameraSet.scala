package skein.simulator

import skein.units.{Quaternion, Vector3}

/** The cameras that vehicles of a kind carry by default.
  *
  * @param listed by their names, in the order of the numbers by which older clients call them
  */
final private[simulator] class CameraSet(listed: (String, Camera)*):
  val places: Map[String, Camera] = listed.toMap

  /** Other names of these cameras: their numbers; none, and `fpv` where no camera is called so, are the
    * first.
    */
  val aliases: Map[String, String] =
    val first = Seq("", "fpv").map(_ -> listed.head._1)
    (first ++ listed.zipWithIndex.map((camera, number) => s"$number" -> camera._1)).toMap -- places.keys

private[simulator] object CameraSet:

  /** The cameras of AirSim's multirotor. AirSim's positions are in a binary asset that is not available,
    * except for the 25 cm between front left and front right; so these positions are ours.
    */
  val OfMultirotor: CameraSet = CameraSet(
    "front_center"  -> looking(Vector3(0.25, 0, 0), yawDeg = 0),
    "front_right"   -> looking(Vector3(0.25, 0.125, 0), yawDeg = 0),
    "front_left"    -> looking(Vector3(0.25, -0.125, 0), yawDeg = 0),
    "bottom_center" -> looking(Vector3(0, 0, 0.05), pitchDeg = -90),
    "back_center"   -> looking(Vector3(-0.25, 0, 0), yawDeg = 180)
  )

  /** The cameras of AirSim's car (`CarPawn`), moved half a metre up and outwards. The simulator's car is
    * longer and higher than AirSim's buggy, and the original positions would be inside it.
    */
  val OfCar: CameraSet = CameraSet(
    "front_center" -> looking(Vector3(2.5, 0, -1.5)),
    "front_right"  -> looking(Vector3(2.5, 0.125, -1.5)),
    "front_left"   -> looking(Vector3(2.5, -0.125, -1.5)),
    "fpv"          -> looking(Vector3(0, -0.25, -1.75)),
    "back_center"  -> looking(Vector3(-2.5, 0, -1.5), yawDeg = 180)
  )

  private def looking(position: Vector3, yawDeg: Double = 0, pitchDeg: Double = 0): Camera =
    Camera(position, Quaternion.of(0, math.toRadians(pitchDeg), math.toRadians(yawDeg)))
