package skein.vtime.agent;

import java.io.BufferedOutputStream;
import java.io.IOException;
import java.io.UncheckedIOException;
import java.net.URL;
import java.net.URLClassLoader;
import java.nio.file.Files;
import java.nio.file.Path;
import java.nio.file.StandardCopyOption;
import java.util.Collections;
import java.util.HashMap;
import java.util.List;
import java.util.stream.Stream;
import java.util.zip.ZipEntry;
import java.util.zip.ZipFile;
import java.util.zip.ZipOutputStream;

/**
 * Rewrites the jars of a program once, in place, as {@link Agent} would at run time: such a program needs no
 * agent, which would prevent a JVM from using an ahead-of-time cache. That cache can hold its lambdas, too.
 */
public final class RewriteJars {
  private static final String AGENT = "skein/vtime/agent/Agent.class";
  private static final String DRAWS = "skein/vtime/agent/Draws.class";

  private RewriteJars() {}

  /**
   * Runs the rewriting.
   *
   * @param folder all jars of the program, including this one, which receives a class
   */
  public static void main(String... folder) throws IOException {
    List<Path> jars;
    try (Stream<Path> files = Files.list(Path.of(folder[0]))) {
      jars = files.filter(file -> file.toString().endsWith(".jar")).sorted().toList();
    }
    var urls = new URL[jars.size()];
    for (int i = 0; i < urls.length; i++) urls[i] = jars.get(i).toUri().toURL();
    // Stack map frames are recomputed, which needs the class hierarchy.
    try (var classes = new URLClassLoader(urls)) {
      var rewriter = new Rewriter(Rewriter.PACKAGES, RewriteJars::fail);
      jars.parallelStream().forEach(jar -> rewrite(jar, rewriter, classes));
    }
  }

  /** Rewrites a jar; a jar without any class to rewrite is kept as it is, and is not compressed again. */
  private static void rewrite(Path jar, Rewriter rewriter, ClassLoader classes) {
    try {
      var rewritten = jar.resolveSibling(jar.getFileName() + ".rewritten");
      try (var zip = new ZipFile(jar.toFile())) {
        var changed = new HashMap<String, byte[]>();
        for (var entry : Collections.list(zip.entries())) {
          if (!entry.getName().endsWith(".class")) continue;
          var before = read(zip, entry);
          var after = rewrite(entry.getName(), before, rewriter, classes);
          if (after != before) changed.put(entry.getName(), after);
        }
        if (changed.isEmpty() && zip.getEntry(AGENT) == null) return;
        try (var out = new ZipOutputStream(new BufferedOutputStream(Files.newOutputStream(rewritten)))) {
          for (var entry : Collections.list(zip.entries())) {
            var bytes = changed.get(entry.getName());
            write(out, entry.getName(), entry.getTime(), bytes == null ? read(zip, entry) : bytes);
            if (entry.getName().equals(AGENT)) write(out, DRAWS, entry.getTime(), Rewriter.DRAWS_CLASS);
          }
        }
      }
      Files.move(rewritten, jar, StandardCopyOption.REPLACE_EXISTING);
    } catch (IOException failure) {
      throw new UncheckedIOException("cannot rewrite " + jar, failure);
    }
  }

  private static byte[] read(ZipFile zip, ZipEntry entry) throws IOException {
    try (var in = zip.getInputStream(entry)) {
      return in.readAllBytes();
    }
  }

  private static byte[] rewrite(String name, byte[] bytes, Rewriter rewriter, ClassLoader classes) {
    var governed = rewriter.transform(classes, name.substring(0, name.length() - 6), null, null, bytes);
    var better = governed == null ? bytes : governed;
    var plain = PlainLambdas.rewrite(better);
    return plain == null ? better : plain;
  }

  private static void write(ZipOutputStream out, String name, long time, byte[] bytes) throws IOException {
    var entry = new ZipEntry(name);
    entry.setTime(time);
    out.putNextEntry(entry);
    out.write(bytes);
    out.closeEntry();
  }

  private static void fail(String className, Throwable cause) {
    throw new IllegalStateException("cannot rewrite " + className, cause);
  }
}
