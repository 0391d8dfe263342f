package skein.measure

import skein.policy.Role
import skein.record.LoopKind
import skein.units.Span

/** The paper's results, from its text and its published result files (RoboticsDesignLab/StreamingSimPaper).
  */
object Published:

  /** A flight of the paper.
    *
    * @param distance absent if it was not published
    * @param observedMs means at the decisions for the evader and for the pursuer
    */
  final case class Flight(
      loop: LoopKind,
      link: String,
      distance: Option[Distance],
      observedMs: Map[TimingObservation, (evader: Double, pursuer: Double)]
  )

  /** Horizontal distance, m: over the last 10 s, and where smallest. */
  final case class Distance(
      mean: Double,
      least: Double,
      most: Double,
      closest: Double,
      closestAtS: Option[Double]
  )

  /** The paper's flight of this loop over this link. Its `paused` used the direct link but waits for every
    * answer, so it is comparable over any link.
    */
  def flight(loop: LoopKind, link: String): Option[Flight] =
    flights.find(flight => flight.loop == loop && (flight.link == link || loop == LoopKind.Paused))

  /** Period between two decisions for a vehicle, and duration of a flight. */
  val Period: Span   = Span.ofMillis(100)
  val Duration: Span = Span.ofSeconds(60)

  val flights: Vector[Flight] = Vector(
    Flight(
      LoopKind.Paused,
      "direct",
      Some(Distance(8.53, 8.41, 8.62, 3.75, Some(5.9))),
      observed(own = (0, 0), opponent = (0, 0), sinceOwn = (100, 100), sinceOpponent = (100, 100))
    ),
    Flight(
      LoopKind.Sequential,
      "direct",
      Some(Distance(12.3, 4.9, 16.9, 3.90, Some(5.9))),
      observed(own = (32, 0.2), opponent = (0.04, 32), sinceOwn = (168, 168), sinceOpponent = (168, 143))
    ),
    Flight(
      LoopKind.Futures,
      "direct",
      Some(Distance(9.83, 9.54, 10.49, 3.93, Some(5.8))),
      observed(own = (40, 0.02), opponent = (0.04, 40), sinceOwn = (137, 133), sinceOpponent = (81, 88))
    ),
    Flight(
      LoopKind.Stream,
      "direct",
      Some(Distance(9.31, 9.02, 9.68, 3.78, Some(6.0))),
      observed(own = (26, 25), opponent = (25, 26), sinceOwn = (79, 79), sinceOpponent = (81, 73))
    ),
    Flight(
      LoopKind.Sequential,
      "vpn",
      Some(Distance(40.5, 26.9, 47.9, 1.9, None)),
      observed(own = (97, 0.2), opponent = (0.06, 97), sinceOwn = (284, 284), sinceOpponent = (284, 236))
    ),
    Flight(
      LoopKind.Futures,
      "vpn",
      Some(Distance(24.2, 4.5, 33.1, 3.5, Some(6.2))),
      observed(own = (118, 0.03), opponent = (0.06, 116), sinceOwn = (198, 179), sinceOpponent = (129, 140))
    ),
    Flight(
      LoopKind.Stream,
      "vpn",
      Some(Distance(8.5, 5.0, 11.6, 3.45, Some(6.0))),
      observed(own = (35, 34), opponent = (34, 35), sinceOwn = (65, 64), sinceOpponent = (66, 61))
    )
  )

  type ByRole = (evader: Double, pursuer: Double)

  def ofRole(published: ByRole, role: String): Double =
    if Role.parse(role) == Role.Pursuer then published.pursuer else published.evader

  private def observed(
      own: ByRole,
      opponent: ByRole,
      sinceOwn: ByRole,
      sinceOpponent: ByRole
  ): Map[TimingObservation, ByRole] =
    Map(
      TimingObservation.OwnAge            -> own,
      TimingObservation.OpponentAge       -> opponent,
      TimingObservation.SinceOwnMove      -> sinceOwn,
      TimingObservation.SinceOpponentMove -> sinceOpponent
    )
