package skein.policy

/** Flees straight away from the nearest other vehicle, and from the first of several equally near. */
final case class Flee(speedMps: Double) extends Policy.Memoryless:

  override def isPlanar: Boolean = true

  def action(seen: Observation): Action =
    val self      = seen.self
    var least     = Double.PositiveInfinity
    var awayNorth = 0.0
    var awayEast  = 0.0
    var other     = 0
    while other < seen.count do
      val north    = seen.northM(self) - seen.northM(other)
      val east     = seen.eastM(self) - seen.eastM(other)
      val distance = StrictMath.hypot(north, east)
      if other != self && distance < least then
        least = distance
        awayNorth = north
        awayEast = east
      other += 1
    val heading =
      if awayNorth == 0 && awayEast == 0 then seen.headingRad else StrictMath.atan2(awayEast, awayNorth)
    seen.along(heading, speedMps)
