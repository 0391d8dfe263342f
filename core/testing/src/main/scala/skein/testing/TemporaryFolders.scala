package skein.testing

import java.nio.file.{Files, Path}
import scala.jdk.CollectionConverters.*
import scala.util.Using

/** Temporary folders for a suite's tests, deleted with their contents when the suite ends. */
trait TemporaryFolders extends munit.FunSuite:

  private object parent extends Fixture[Path]("temporary folders"):
    private lazy val made = Files.createTempDirectory("skein")
    private var isMade    = false

    def apply(): Path =
      isMade = true
      made

    override def afterAll(): Unit = if isMade then
      Using.resource(
        Files.walk(made)
      )(_.iterator.asScala.toVector.reverse.foreach(Files.deleteIfExists(_): Unit))

  override def munitFixtures: Seq[munit.AnyFixture[?]] = super.munitFixtures :+ parent

  protected def temporaryFolder(): Path = Files.createTempDirectory(parent(), "test")

  protected val folder: FunFixture[Path] = FunFixture[Path](_ => temporaryFolder(), _ => ())
