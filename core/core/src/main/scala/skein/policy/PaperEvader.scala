package skein.policy

/** The paper's evader: inside one of the pursuer's two turning circles it heads for safety; near the pursuer
  * it breaks away at a right angle; far from it, it runs along the line of sight.
  *
  * With the evader at (x, y) in the pursuer's frame and the pursuer's commanded heading θp:
  *   - in the right circle, x² + (y − R)² < R²: θp + atan2(y + R, x)
  *   - in the left circle, x² + (y + R)² < R²: θp + atan2(y − R, x)
  *   - within 2R: θp + atan2(y, x) + π/2
  *   - else: θp + atan2(y, x)
  *
  * @param turningRadiusM R, the pursuer's assumed turning radius; the paper's is 8 m
  */
final case class PaperEvader(turningRadiusM: Double = 8.0) extends HeadingPolicy.Memoryless:

  def heading(seen: PlanarObservation): Double =
    import seen.*
    val radius = turningRadiusM
    val cos    = StrictMath.cos(opponentHeadingRad)
    val sin    = StrictMath.sin(opponentHeadingRad)
    val x      = -dxM * cos - dyM * sin
    val y      = dxM * sin - dyM * cos
    if inCircle(x, y - radius) then opponentHeadingRad + StrictMath.atan2(y + radius, x)
    else if inCircle(x, y + radius) then opponentHeadingRad + StrictMath.atan2(y - radius, x)
    else if x * x + y * y < 4 * radius * radius then opponentHeadingRad + StrictMath.atan2(y, x) + math.Pi / 2
    else opponentHeadingRad + StrictMath.atan2(y, x)

  override def guessed(draw: Int => Double): PaperEvader =
    copy(turningRadiusM = turningRadiusM * (1 + PaperEvader.RadiusSd * draw(0)))

  private def inCircle(x: Double, y: Double): Boolean = x * x + y * y < turningRadiusM * turningRadiusM

object PaperEvader:
  private val RadiusSd = 0.1
