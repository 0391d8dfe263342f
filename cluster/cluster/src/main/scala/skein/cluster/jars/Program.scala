package skein.cluster.jars

/** A jar, by what is in it.
  *
  * @param bytes its size
  */
final case class Jar(sha256: Sha256, bytes: Long)

/** A program that another machine can run: what its class path holds, and where it starts.
  *
  * @param main the class whose `main` starts the commands
  * @param jars in the order of the class path
  */
final case class Program(main: String, jars: Vector[Jar]):

  /** As text: its name, the class, a line for each jar. */
  private[cluster] lazy val text: Array[Byte] =
    (Program.Format +: main +: jars.map(jar => s"${jar.sha256} ${jar.bytes}"))
      .map(_ + "\n")
      .mkString
      .getBytes("UTF-8")

  /** Names the program whole: who accepts it knows each byte of it. */
  lazy val digest: Sha256 = Sha256.of(text)

  /** Of all its jars. */
  def bytes: Long = jars.map(_.bytes).sum

object Program:
  private[jars] val MostText = 256 << 10
  private val MostJars       = 2048

  /** Of one program, 1 GiB. */
  val MostBytes: Long = 1L << 30

  private val Format = "skein program 1"

  /** @return or what was expected, and what came */
  private[jars] def read(bytes: Array[Byte]): Either[String, Program] =
    String(bytes, "UTF-8").linesIterator.toList match
      case Format :: main :: jars =>
        for
          _ <- Either.cond(isClass(main), (), s"expected the name of a class, came '${main.take(80)}'")
          _ <-
            Either.cond(jars.sizeIs <= MostJars, (), s"expected at most $MostJars jars, came ${jars.size}")
          listed <- jars.foldLeft[Either[String, Vector[Jar]]](Right(Vector.empty)): (before, line) =>
            before.flatMap(all => jar(line).map(all :+ _))
          program = Program(main, listed)
          _ <- Either.cond(
            program.bytes <= MostBytes,
            (),
            s"expected a program of at most ${MostBytes >> 20} MiB, came ${program.bytes >> 20} MiB"
          )
        yield program
      case other => Left(s"expected '$Format', came '${other.headOption.getOrElse("").take(80)}'")

  /** A word of a command line, and no option. */
  private def isClass(name: String) =
    name.matches("""[\p{L}_$][\p{L}\p{N}_$]*(\.[\p{L}_$][\p{L}\p{N}_$]*)*""")

  private def jar(line: String): Either[String, Jar] = line match
    case s"$sha256 $bytes" =>
      for
        content <- Sha256.parse(sha256)
        size    <- bytes.toLongOption.filter(size => size >= 0 && size <= MostBytes).toRight(
          s"expected a jar's size of at most ${MostBytes >> 20} MiB, came '${bytes.take(80)}'"
        )
      yield Jar(content, size)
    case _ => Left(s"expected a jar's SHA-256 and size, came '${line.take(80)}'")
