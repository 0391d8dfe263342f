package skein.signal

import skein.units.*

/** The text form of latency profiles, for flags and configuration files. */
private object LatencyText:
  import LatencyDistribution.*
  import LatencyError.*
  import LatencyProfile.Steady

  private val named =
    List(LatencyProfile.none, LatencyProfile.direct, LatencyProfile.vpn, LatencyProfile.vpnMixed)
      .map(profile => profile.name -> profile)
      .toMap

  def parse(text: String, read: String => Either[String, String]): Either[LatencyError, LatencyProfile] =
    def malformed(expected: String, came: String)      = Malformed(text, expected, came)
    def time(came: String): Either[LatencyError, Span] =
      span(came).toRight(malformed("a time such as 200ms", came))

    def before(rest: String, what: String)(isSame: LatencyProfile => Boolean) =
      parse(rest, read).filterOrElse(!layers(_).exists(isSame), malformed(s"one $what", rest))

    text match
      case s"rate:$rate,$rest" =>
        for
          bandwidth <- Bandwidth.parse(rate).left.map(_ => malformed(Bandwidth.form, rate))
          latency   <- before(rest, "rate")(_.isInstanceOf[LatencyProfile.Limited])
        yield LatencyProfile.Limited(text, latency, bandwidth)
      case s"rate:$came"             => Left(malformed("a rate and a profile such as 50mbit,direct", came))
      case s"correlated:$over,$rest" =>
        for
          mean    <- time(over).filterOrElse(_ > Span.Zero, malformed("more than 0", over))
          latency <- before(rest, "time constant")(_.isInstanceOf[LatencyProfile.Correlated])
        yield LatencyProfile.Correlated(text, latency, mean)
      case s"correlated:$came" => Left(malformed("a time and a profile such as 250ms,direct", came))
      case s"loss:$loss,$rest" =>
        for
          by      <- Impairment.loss(loss).left.map(malformed(_, loss))
          latency <- before(rest, "loss")(impaired(_.isInstanceOf[Impairment.Loss]))
        yield LatencyProfile.Impaired(text, latency, by)
      case s"loss:$came" => Left(malformed("a share and a profile such as 5%,vpn or 5%/4,vpn", came))
      case s"outage:$outage,$rest" =>
        for
          by      <- Impairment.outage(outage, span).left.map(malformed(_, outage))
          latency <- before(rest, "outage")(impaired(_.isInstanceOf[Impairment.Outage]))
        yield LatencyProfile.Impaired(text, latency, by)
      case s"outage:$came"          => Left(malformed("two times and a profile such as 1s/10s,vpn", came))
      case s"constant:$roundTrip"   => time(roundTrip).map(t => Steady(text, Constant(t)))
      case s"uniform:$least..$most" =>
        for
          from  <- time(least)
          until <- time(most)
          _     <- Either.cond(from <= until, (), malformed("the smaller time first", s"$least..$most"))
        yield Steady(text, Uniform(from, until))
      case s"uniform:$came"            => Left(malformed("two times such as 10ms..40ms", came))
      case s"lognormal:$median,$sigma" =>
        for
          middle <- time(median)
          spread <- sigma.trim.toDoubleOption
            .filter(s => s >= 0 && s <= 3)
            .toRight(malformed("a standard deviation of the logarithm from 0 to 3", sigma))
        yield Steady(text, LogNormal(middle, spread))
      case s"lognormal:$came" =>
        Left(malformed("the median and the standard deviation of the logarithm such as 36ms,0.3", came))
      case s"file:$path" =>
        for
          content      <- read(path).left.map(Unreadable(path, _))
          roundTripsMs <- samples(path, content)
        yield Steady(text, ofSamples(roundTripsMs))
      case _ => named.get(text).toRight(UnknownProfile(text))

  private def layers(profile: LatencyProfile): Iterator[LatencyProfile] =
    Iterator.unfold(Option(profile))(_.map(layer => (layer, layer.within)))

  private def impaired(by: Impairment => Boolean)(layer: LatencyProfile): Boolean = layer match
    case LatencyProfile.Impaired(_, _, impairment) => by(impairment)
    case _                                         => false

  private def samples(path: String, content: String): Either[LatencyError, Vector[Double]] =
    val lines = content.linesIterator.map(_.trim).zipWithIndex.filterNot: (line, _) =>
      line.isEmpty || line.startsWith("#")
    Expect
      .each(lines): (line, index) =>
        line.toDoubleOption.filter(ms => ms >= 0 && ms <= 3_600_000).toRight(BadSample(path, index + 1, line))
      .filterOrElse(_.nonEmpty, NoSamples(path))

  private val time = """\s*(\d+(?:\.\d+)?)\s*(us|ms|s)\s*""".r

  /** Reads a time of at most an hour; a longer round trip is a mistake. */
  private def span(text: String): Option[Span] = text match
    case time(number, unit) =>
      val ms = unit match
        case "us" => number.toDouble / 1000
        case "ms" => number.toDouble
        case _    => number.toDouble * 1000
      Option.when(ms <= 3_600_000)(Span.ofMillis(ms))
    case _ => None
