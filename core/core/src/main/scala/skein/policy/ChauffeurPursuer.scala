package skein.policy

/** The pursuer of Isaacs' homicidal chauffeur, who captures whatever the evader does where that is possible
  * at all: it turns hard towards the evader and dashes, unless the evader would slip by it; then it swerves,
  * flies straight away until the evader is far enough for a turn towards it.
  *
  * Whether the evader would slip by follows from [[HomicidalChauffeur.radiusNeededM]]: it must not exceed a
  * limit, which is the capture radius for an evader ahead, up to the edge of what it can be run over in, and
  * falls linearly with the angle to the least radius that captures, for an evader behind. While the pursuer
  * turns, no evader can raise the radius that is needed, and the limit rises, for the evader comes to the
  * front: so the pursuer does not waver between the two, and the time between decisions does not undo what a
  * swerve has won. Without that slack, an evader that keeps to the barrier and slips behind it by the length
  * of a step makes the pursuer swerve again and again.
  *
  * It captures, but not in the least time, for which see Merz, The Homicidal Chauffeur (Stanford, 1971):
  * there the swerve turns away. At γ = 0.5 every pursuit in `HomicidalChauffeurSimulation` ends within
  * distance / (vP − vE) and 19 times turning radius / vP. Source of the game, its barrier and the swerve:
  * Isaacs, Differential Games (1965).
  *
  * @param speedRatio γ, the evader's speed over the pursuer's, in 0 to 1
  * @param captureRadiusM below 1.05 times [[HomicidalChauffeur.thresholdM]] it flies as if it were that
  * @param turnRateRadPerS the most that it turns; speed over turning radius
  */
final case class ChauffeurPursuer(
    turningRadiusM: Double = 8.0,
    speedRatio: Double = 0.5,
    captureRadiusM: Double = 1.5,
    turnRateRadPerS: Double = 1.25
) extends HeadingPolicy.Memoryless:
  require(turnRateRadPerS > 0, s"the turn rate must be positive, came $turnRateRadPerS rad/s")

  private val game  = HomicidalChauffeur(turningRadiusM, speedRatio)
  private val most  = math.max(captureRadiusM, 1.05 * game.thresholdM)
  private val falls = (most - game.thresholdM) / (math.Pi - game.edgeRad)

  def heading(seen: PlanarObservation): Double =
    import seen.*
    val cos   = StrictMath.cos(ownHeadingRad)
    val sin   = StrictMath.sin(ownHeadingRad)
    val ahead = dxM * cos + dyM * sin
    val aside = -dxM * sin + dyM * cos
    val off   = math.abs(StrictMath.atan2(aside, ahead))
    val limit = most - falls * math.max(0.0, off - game.edgeRad)
    if game.radiusNeededM(ahead, aside) > limit then ownHeadingRad
    else Turn.towards(ownHeadingRad, StrictMath.atan2(dyM, dxM), turnRateRadPerS * elapsedS)
