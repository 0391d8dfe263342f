package skein.planning

/** The limits of a vehicle's commands.
  *
  * @param minSpeed minimum speed, m/s
  * @param maxSpeed maximum speed, m/s; if it equals the minimum, only the heading is planned
  * @param maxTurnRate maximum turn rate, rad/s
  * @param turningRadius minimum turning radius, m; limits the turn rate to speed / radius; 0 for a vehicle
  *   that turns on the spot
  */
final case class CommandLimits(
    minSpeed: Double,
    maxSpeed: Double,
    maxTurnRate: Double,
    turningRadius: Double = 0
):
  require(
    0 <= minSpeed && minSpeed <= maxSpeed && maxTurnRate >= 0 && turningRadius >= 0,
    s"limits must not be negative, the least speed not above the greatest: $this"
  )

  def curvature: Double = if turningRadius > 0 then 1 / turningRadius else 1e9

  def turnRateAt(speed: Double): Double = math.min(maxTurnRate, speed * curvature)

object CommandLimits:
  /** The limits of the paper's pursuer: a constant 10 m/s and a turning radius of 8 m, hence 1.25 rad/s. */
  val paperPursuer: CommandLimits = CommandLimits(10, 10, 1.25, 8)
