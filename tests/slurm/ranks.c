/* A program of MPI for tests: every rank adds x, rank 0 prints the sum, the number of ranks and that of Slurm's nodes. */
#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>

int main(int argc, char** argv) {
    int ranks = 0, rank = 0;
    MPI_Init(&argc, &argv);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    double x = argc > 1 ? atof(argv[1]) : 0, sum = 0;
    MPI_Reduce(&x, &sum, 1, MPI_DOUBLE, MPI_SUM, 0, MPI_COMM_WORLD);
    const char* node = getenv("SLURM_NODEID");
    int mine = node ? atoi(node) + 1 : 1, nodes = 0;
    MPI_Reduce(&mine, &nodes, 1, MPI_INT, MPI_MAX, 0, MPI_COMM_WORLD);
    if (rank == 0) printf("sum = %.17g\nranks = %d\nnodes = %d\n", sum, ranks, nodes);
    MPI_Finalize();
    return 0;
}
