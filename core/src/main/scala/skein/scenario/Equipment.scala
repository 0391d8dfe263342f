package skein.scenario

/** What a vehicle carries to see by, besides what every vehicle has. A built-in simulator is made with it; another needs it
  * in its `settings.json`.
  */
enum Equipment:
  def vehicle: String
  def name: String

  /** A lidar that turns around the vehicle's down axis, which its policy reads as a sensor of this name: `northM`, `eastM`,
    * `downM`, where it was, and then, from north and clockwise, how far the nearest thing is in each of [[Sectors]] equal
    * sectors of the compass, in the plane, m. Things more than [[BandM]] above or below are passed over; where there is
    * nothing else, it is the lidar's range.
    *
    * @param verticalFovDeg
    *   lower, upper; negative looks down
    */
  case Lidar(
      vehicle: String,
      name: String,
      channels: Int = 16,
      pointsPerSecond: Int = 40_000,
      rotationsPerSecond: Int = 10,
      rangeM: Double = 40,
      verticalFovDeg: (Double, Double) = (-20, 20)
  )

  /** A camera in front of the vehicle, which looks ahead.
    *
    * @param fovDeg
    *   horizontal
    */
  case Camera(vehicle: String, name: String, width: Int, height: Int, fovDeg: Double)

object Equipment:
  /** Of a lidar as policies read it: 3° each. */
  val Sectors = 120

  val BandM = 2.0
