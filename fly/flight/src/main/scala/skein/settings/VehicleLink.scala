package skein.settings

import skein.signal.LatencyProfile
import skein.units.*

/** The link between two vehicles: messages take half of a sampled round trip, and lost ones are not sent
  * again. If an object of the scene stands between the two, none arrives.
  *
  * @param range distance beyond which none arrives, either; absent: at any distance
  */
final case class VehicleLink(profile: LatencyProfile, range: Option[Metres]):
  def text: String = range.fold("")(far => s"range:${PlainNumber.text(far.value)}m,") + profile.name

object VehicleLink:
  def parse(text: String): Either[String, VehicleLink] = text match
    case s"range:$range,$rest" =>
      for
        metres <- range
          .stripSuffix("m")
          .toDoubleOption
          .filter(far => range.endsWith("m") && far > 0 && far.isFinite)
          .toRight(s"expected a range such as 60m, got '$range'")
        profile <- profile(rest)
      yield VehicleLink(profile, Some(Metres(metres)))
    case _ => profile(text).map(VehicleLink(_, None))

  private def profile(text: String): Either[String, LatencyProfile] =
    LinkText
      .profile(text)
      .filterOrElse(_.bandwidth.isEmpty, s"expected no rate, since messages have no size, got '$text'")
