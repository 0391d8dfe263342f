package skein.vehicle

import skein.signal.Impairment
import skein.units.{Expect, Span}

/** Errors of a vehicle's readings of its own motion. Standard deviations are of each axis.
  *
  * @param text the text that [[SensorNoise.parse]] reads back
  * @param positionM white noise of the position, m
  * @param velocityMps white noise of the velocity, m/s
  * @param headingRad white noise of the heading, rad
  * @param driftM further error of the position that changes slowly, as a satellite receiver's: a first-order
  *   Gauss–Markov process, m
  * @param driftS its correlation time, s
  * @param dropout share of readings that are missing, independently
  * @param outage stretches in which all readings are missing
  */
final case class SensorNoise(
    text: String,
    positionM: Double = 0,
    velocityMps: Double = 0,
    headingRad: Double = 0,
    driftM: Double = 0,
    driftS: Double = 60,
    dropout: Double = 0,
    outage: Option[Impairment.Outage] = None
):
  /** Only what decides which readings are missing; None if none is. */
  private[skein] def ofMissing: Option[SensorNoise] =
    Option.when(dropout > 0 || outage.isDefined)(SensorNoise(text, dropout = dropout, outage = outage))

object SensorNoise:
  import Assignments.number

  val forms: String =
    "position=M, velocity=M/S, heading=RAD (standard deviations), drift=M/TIME such as 1.5/60s, dropout=SHARE such " +
      "as 2%, outage=LENGTH/EVERY such as 1s/20s, separated by commas"

  /** Reads, for example, `position=0.1,drift=1.5/60s,dropout=2%`. Left says what was expected. */
  def parse(text: String): Either[String, SensorNoise] = Assignments.read(text, SensorNoise(text))(one)

  private def one(of: SensorNoise, word: String): Either[String, SensorNoise] = word match
    case s"position=$x" => number(word, x, 0, 100).map(sd => of.copy(positionM = sd))
    case s"velocity=$x" => number(word, x, 0, 100).map(sd => of.copy(velocityMps = sd))
    case s"heading=$x"  => number(word, x, 0, 3).map(sd => of.copy(headingRad = sd))
    case s"drift=$x/$t" =>
      for
        sd   <- number(word, x, 0, 100)
        time <- time(word, t)
      yield of.copy(driftM = sd, driftS = time.toSeconds)
    case s"dropout=$x" =>
      Impairment.percent(x).filter(share => share >= 0 && share <= MostDropout)
        .map(share => of.copy(dropout = share))
        .toRight(s"expected a share from 0% to 90%, got '$word'")
    case s"outage=$x/$y" =>
      for
        lasts <- time(word, x)
        every <- time(word, y)
        _     <- Expect.that(lasts <= LongestOutage && lasts < every):
          s"expected at most ${LongestOutage.toSeconds.toInt} s, and a longer time from one to the next, got '$word'"
      yield of.copy(outage = Some(Impairment.Outage(lasts, every)))
    case _ => Left(s"expected $forms; got '$word'")

  private def time(word: String, text: String): Either[String, Span] =
    Span.parse(
      text
    ).toOption.filter(_ >= Tick).toRight(s"expected times from 0.1s on, got '$word'")

  private val MostDropout = 0.9

  /** Interval at which drift is drawn; in between it is linear. */
  private[skein] val Tick: Span = Span.ofMillis(100)

  /** A simulator that is silent for 10 s ends a flight. */
  private val LongestOutage = Span.ofSeconds(5)
