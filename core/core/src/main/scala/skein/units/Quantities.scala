package skein.units

/** A length in metres. A bare `double` at run time. */
opaque type Metres = Double

object Metres:
  inline def apply(metres: Double): Metres            = metres
  extension (length: Metres) inline def value: Double = length

/** A speed in metres per second. A bare `double` at run time. */
opaque type MetresPerSecond = Double

object MetresPerSecond:
  inline def apply(metresPerSecond: Double): MetresPerSecond  = metresPerSecond
  extension (speed: MetresPerSecond) inline def value: Double = speed

/** An angle in radians. Headings are measured from north (+x) towards east (+y), as in NED. A bare `double`.
  */
opaque type Radians = Double

object Radians:
  inline def apply(radians: Double): Radians          = radians
  extension (angle: Radians) inline def value: Double = angle
