package skein.measure

import skein.record.{DecisionRow, Observations}
import skein.units.Span

/** The paper's four observations at every decision. */
enum TimingObservation(
    val title: String,
    of: Observations => Option[Span],
    val isOfOpponent: Boolean = false
):

  /** How long ago the reading of the vehicle itself arrived. */
  case OwnAge extends TimingObservation("own location age", observed => Some(observed.ownAge))

  /** How long ago the reading of its opponent arrived. */
  case OpponentAge
      extends TimingObservation(
        "opponent's location age",
        observed => Some(observed.opponentAge),
        isOfOpponent = true
      )

  /** How long ago the vehicle was last commanded. */
  case SinceOwnMove extends TimingObservation("time since own last move", _.sinceOwnMove)

  /** How long ago its opponent was last commanded. */
  case SinceOpponentMove
      extends TimingObservation("time since opponent's last move", _.sinceOpponentMove, isOfOpponent = true)

  /** ms; absent before the first move. */
  def ms(decision: DecisionRow): Option[Double] = of(decision.observations).map(_.toMillis)
