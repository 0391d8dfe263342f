package skein.settings

/** A source of images and clouds that a flight records. */
enum ImageSource:
  /** The cameras and lidars that its policies use. */
  case Seen

  case Camera(name: String, hz: Double)

  def text: String = this match
    case Seen             => ImageSource.SeenWord
    case Camera(name, hz) => s"$name@${PlainNumber.text(hz)}"

object ImageSource:
  private val SeenWord = "seen"

  /** Maximum rate, which no simulator's camera exceeds, Hz. */
  val MostHz = 240.0

  private val Form = """([^@\s]+)@([0-9]+(?:\.[0-9]+)?)""".r

  def parse(text: String): Either[String, ImageSource] = text match
    case SeenWord                                                     => Right(Seen)
    case Form(camera, hz) if hz.toDouble > 0 && hz.toDouble <= MostHz => Right(Camera(camera, hz.toDouble))
    case other                                                        =>
      Left(
        s"expected seen, or CAMERA@HZ with up to ${MostHz.toInt} images a " +
          s"second, for example front_center@10, got '$other'"
      )
