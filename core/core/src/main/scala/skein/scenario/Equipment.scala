package skein.scenario

/** A camera or lidar of a vehicle, in addition to those of every vehicle. The built-in simulator configures
  * it from here; another simulator needs it in its `settings.json`.
  */
enum Equipment:
  def vehicle: String
  def name: String

  /** A lidar that turns around the vehicle's down axis. Policies read it as a sensor of this name: its
    * position `northM`, `eastM`, `downM`; then, clockwise from north, the distance in the plane to the
    * nearest thing in each of [[Sectors]] equal sectors of the compass, m. Things more than [[BandM]] above
    * or below do not count; an empty sector has the lidar's range.
    *
    * @param verticalFovDeg lower, upper; negative looks down
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

  /** A camera at the front of the vehicle that points forward.
    *
    * @param fovDeg horizontal
    */
  case Camera(vehicle: String, name: String, width: Int, height: Int, fovDeg: Double)

object Equipment:
  val Sectors = 120

  val BandM = 2.0
