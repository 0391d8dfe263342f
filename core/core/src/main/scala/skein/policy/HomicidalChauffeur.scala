package skein.policy

/** The geometry of Isaacs' game of the homicidal chauffeur: a pursuer with limited turn rate against a slower
  * evader that turns freely. Positions in the pursuer's frame are distances `ahead` of it and `aside`, to
  * either side.
  *
  * Its barriers are involutes. A pursuer that turns hard towards the evader's side follows a circle of radius
  * R about a centre to its side; with ρ the evader's distance from that centre, the evader does best to run
  * straight along the tangent of the circle of radius γ·R about the same centre. So it reaches the angle
  * arccos γ to the pursuer's heading, the edge of the usable part, when the pursuer has turned by τ. Its
  * distance is then
  *
  * R·√(1 − γ²) + γ·R·τ − √(ρ² − γ²·R²)
  *
  * and it moves around the pursuer as fast as the pursuer approaches. Derived from the barrier's course
  * backwards from the edge of the usable part, Isaacs, Differential Games (1965); the involutes of one τ are
  * the level lines of this distance. `HomicidalChauffeurSimulation` simulates it.
  *
  * @param turningRadiusM R, the pursuer's turning radius
  * @param speedRatio γ, the evader's speed over the pursuer's, between 0 and 1
  */
final case class HomicidalChauffeur(turningRadiusM: Double, speedRatio: Double):
  require(turningRadiusM > 0, s"the turning radius must be positive, got $turningRadiusM m")
  require(speedRatio >= 0 && speedRatio <= 1, s"the ratio of speeds must be in 0 to 1, got $speedRatio")

  /** arccos γ: an evader at a smaller angle to the pursuer's heading cannot maintain its distance. */
  val edgeRad: Double = StrictMath.acos(speedRatio)

  private val edgeSine    = math.sqrt(1 - speedRatio * speedRatio)
  private val innerRadius = speedRatio * turningRadiusM

  /** The threshold of the capture radius: R·(√(1 − γ²) + γ·arcsin γ − 1). Above it, the pursuer captures from
    * everywhere; below it, the evader escapes unless it starts between the barriers. At the threshold the two
    * barriers touch, straight ahead, at the distance γ·R.
    */
  val thresholdM: Double = turningRadiusM * (edgeSine + speedRatio * StrictMath.asin(speedRatio) - 1)

  /** The smallest capture radius with which a pursuer that turns hard towards this evader's side, and then
    * dashes, captures every evader. Infinite if the evader can wait at the centre of the turning circle;
    * negative if it is far away.
    */
  def radiusNeededM(aheadM: Double, asideM: Double): Double =
    val beyond = math.abs(asideM) - turningRadiusM
    val square = beyond * beyond + aheadM * aheadM - innerRadius * innerRadius
    if square <= 0 then Double.PositiveInfinity
    else
      val tangent = math.sqrt(square)
      val turn = StrictMath.atan2(beyond, aheadM) + math.Pi - StrictMath.atan2(innerRadius, tangent) - edgeRad
      val turned = turn - 2 * math.Pi * math.floor(turn / (2 * math.Pi))
      turningRadiusM * edgeSine + innerRadius * turned - tangent
