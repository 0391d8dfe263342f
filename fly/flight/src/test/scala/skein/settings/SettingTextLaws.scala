package skein.settings

import org.scalacheck.Gen
import org.scalacheck.Prop.*
import skein.signal.LatencyProfile
import skein.units.Metres

class SettingTextLaws extends munit.ScalaCheckSuite:

  /** Numbers of all magnitudes up to a maximum, and what users write: few digits. */
  private def numbers(most: Double) =
    Gen.oneOf(
      Gen.choose(-12.0, StrictMath.log10(most)).map(StrictMath.pow(10, _)),
      Gen.choose(1L, (most * 1000).toLong).map(_ / 1000.0)
    ).filter(number => number > 0 && number <= most)

  property("a link between vehicles is read back from its text, to the bit"):
    forAll(numbers(1e5)): range =>
      val link = VehicleLink(LatencyProfile.vpn, Some(Metres(range)))
      assertEquals(VehicleLink.parse(link.text), Right(link))

  property("a source of images is read back from its text, to the bit"):
    forAll(numbers(ImageSource.MostHz)): hz =>
      val source = ImageSource.Camera("front_center", hz)
      assertEquals(ImageSource.parse(source.text), Right(source))
