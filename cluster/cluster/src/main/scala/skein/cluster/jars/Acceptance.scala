package skein.cluster.jars

import java.io.IOException
import java.nio.file.Path
import scala.collection.immutable.ArraySeq

/** Which programs of others a worker runs, and how it comes by them.
  *
  * @param digests of the programs; others are refused, whoever offers them
  * @param store for what is not on this process's own class path
  * @param own the class path of this process: what is there already need not come
  */
final class Acceptance(
    digests: Set[Sha256],
    val store: JarStore,
    own: => Vector[Path] = ClassPath.current
):
  /** @return or why this program is not run */
  def of(digest: Sha256): Either[String, Sha256] =
    Either.cond(
      digests(digest),
      digest,
      if digests.isEmpty then
        "the coordinator ships its program to workers that are started " +
          "with --accept-jars and the digest that it prints"
      else "the coordinator ships another program than those that --accept-jars names"
    )

  /** Gets a program. What has come is held to its digest before this returns.
    *
    * @param piece of something by its digest, from an offset on; empty where there is nothing
    * @param tell what comes, in a line for a person
    */
  private[cluster] def fetch(digest: Sha256, tell: String => Unit)(
      piece: (Sha256, Long) => Either[NotFetched, ArraySeq[Byte]]
  ): Either[NotFetched, Fetched] =
    def refused(wrong: String) = NotFetched.Refused(wrong)
    for
      _    <- of(digest).left.map(refused)
      text <- piece(digest, 0)
      _    <- Either.cond(
        text.length <= Program.MostText && Sha256.of(text.toArray) == digest,
        (),
        refused("what came as the program's list of jars is another one")
      )
      program <- Program.read(text.toArray).left.map(refused)
      files   <- files(program, tell)(piece)
    yield Fetched(digest, program.main, files)

  private def files(program: Program, tell: String => Unit)(
      piece: (Sha256, Long) => Either[NotFetched, ArraySeq[Byte]]
  ): Either[NotFetched, Vector[Path]] =
    try
      val here  = own.map(path => ClassPath.jar(path).sha256 -> path).toMap
      val known =
        program.jars.distinct.flatMap(jar => here.get(jar.sha256).orElse(store.find(jar)).map(jar -> _))
      val missing = program.jars.distinct.filterNot(known.toMap.contains)
      tell(
        s"the program has ${program.jars.size} jars, of which ${missing.size} " +
          s"come from the coordinator, ${missing.map(_.bytes).sum} bytes"
      )
      missing
        .foldLeft[Either[NotFetched, Map[Jar, Path]]](Right(known.toMap)): (before, jar) =>
          before.flatMap(files => store.add(jar)(piece(jar.sha256, _)).map(file => files + (jar -> file)))
        .map(program.jars.map)
    catch case failed: IOException => Left(NotFetched.Refused(s"cannot read jars: $failed"))

object Acceptance:
  /** Of no program. */
  val none: Acceptance = Acceptance(Set.empty, JarStore.ofUser)

/** A program that is here, checked.
  *
  * @param main the class whose `main` starts the commands
  */
final case class Fetched(digest: Sha256, main: String, classPath: Vector[Path])
