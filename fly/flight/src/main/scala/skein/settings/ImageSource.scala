package skein.settings

/** Whose images and clouds a flight records. */
enum ImageSource:
  /** Of the cameras and lidars that its policies look through. */
  case Seen

  /** Of a camera of every vehicle, for nobody but who looks at the flight.
    *
    * @param hz images a second
    */
  case Camera(name: String, hz: Double)

  /** As [[ImageSource.parse]] reads it. */
  def text: String = this match
    case Seen             => ImageSource.SeenWord
    case Camera(name, hz) => s"$name@$hz"

object ImageSource:
  private val SeenWord = "seen"

  /** No camera of a simulator gives more. */
  val MostHz = 240.0

  private val Form = """([^@\s]+)@([0-9]+(?:\.[0-9]+)?)""".r

  def parse(text: String): Either[String, ImageSource] = text match
    case SeenWord                                                     => Right(Seen)
    case Form(camera, hz) if hz.toDouble > 0 && hz.toDouble <= MostHz => Right(Camera(camera, hz.toDouble))
    case other                                                        =>
      Left(
        s"expected seen, or CAMERA@HZ with up to ${MostHz.toInt} images a " +
          s"second, for example front_center@10, came '$other'"
      )
