package skein.measure

import skein.record.{DecisionRow, Observations}
import skein.units.Span

/** The paper's four observations at every decision. */
enum TimingObservation(
    val title: String,
    of: Observations => Option[Span],
    val isOfOpponent: Boolean = false
):

  /** Time since the reading of the vehicle itself was received. */
  case OwnAge extends TimingObservation("own location age", observed => Some(observed.ownAge))

  /** Time since the reading of its opponent was received. */
  case OpponentAge
      extends TimingObservation(
        "opponent's location age",
        observed => Some(observed.opponentAge),
        isOfOpponent = true
      )

  /** Time since the last command to the vehicle. */
  case SinceOwnMove extends TimingObservation("time since own last move", _.sinceOwnMove)

  /** Time since the last command to its opponent. */
  case SinceOpponentMove
      extends TimingObservation("time since opponent's last move", _.sinceOpponentMove, isOfOpponent = true)

  /** The value, ms; absent before the first move. */
  def ms(decision: DecisionRow): Option[Double] = of(decision.observations).map(_.toMillis)
