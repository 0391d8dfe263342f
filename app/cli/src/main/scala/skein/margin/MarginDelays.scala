package skein.margin

import skein.signal.LatencyProfile
import skein.units.Decimals.significant
import skein.units.{Expect, Span}

/** The text form of evenly spaced constant round trips: `50ms..200ms/4`. */
object MarginDelays:
  private val form = "FROM..TO/COUNT, for example 50ms..200ms/4"

  /** @return Left lists the expected form and the given text */
  def read(text: String): Either[String, Vector[LatencyProfile]] =
    def wrong = s"expected $form, got '$text'"
    text match
      case s"$from..$to/$count" =>
        for
          least  <- Span.parse(from).left.map(_ => wrong)
          most   <- Span.parse(to).left.map(_ => wrong)
          number <- count.toIntOption.filter(_ >= 1).toRight(wrong)
          _      <- Expect.that(least < most || number == 1 && least == most)(wrong)
          delays = Vector.tabulate(number): index =>
            if number == 1 then least.toMillis
            else least.toMillis + (most.toMillis - least.toMillis) * index / (number - 1)
          links <- Expect.each(delays)(ms =>
            LatencyProfile.parse(s"constant:${ms.significant(6)}ms", Left(_)).left.map(_.message)
          )
        yield links
      case _ => Left(wrong)
