package skein.scenario

/** A camera or lidar that a vehicle has in addition to the default ones. The built-in simulator creates it
  * from this description; other simulators need it in their `settings.json`.
  */
enum Equipment:
  def vehicle: String
  def name: String

  /** A lidar that turns around the vehicle's down axis. Policies read it as a sensor with this name. Its
    * columns are its position `northM`, `eastM`, `downM`; then, for each of [[Sectors]] equal sectors of the
    * compass, clockwise from north, the horizontal distance to the nearest surface, m. Surfaces more than
    * [[BandM]] above or below are ignored; an empty sector has the lidar's range.
    *
    * @param verticalFovDeg lower and upper angle; negative is downwards
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
    * @param fovDeg horizontal field of view
    */
  case Camera(vehicle: String, name: String, width: Int, height: Int, fovDeg: Double)

object Equipment:
  val Sectors = 120

  val BandM = 2.0
