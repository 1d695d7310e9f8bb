// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// hypre's conjugate gradients with BoomerAMG, to 1e-6, on the matrix of the free cells; what counts is set-up and
// solution, not the assembly of the matrix: hypre SIDE LAPLACE
#include <cmath>

#include <HYPRE.h>
#include <HYPRE_IJ_mv.h>
#include <HYPRE_krylov.h>
#include <HYPRE_parcsr_ls.h>
#include <mpi.h>

#include "peer.hpp"

int main(int count, char** words) {
    MPI_Init(&count, &words);
    HYPRE_Init();
    std::size_t const side = peer::size_of(words[1]);
    std::vector<float> const values = peer::read(words[2], side);
    std::vector<HYPRE_BigInt> number(values.size(), -1);
    HYPRE_BigInt free = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        number[i] = std::isnan(values[i]) ? free++ : -1;
    }
    HYPRE_IJMatrix matrix;
    HYPRE_IJVector right;
    HYPRE_IJVector solution;
    HYPRE_IJMatrixCreate(MPI_COMM_WORLD, 0, free - 1, 0, free - 1, &matrix);
    HYPRE_IJVectorCreate(MPI_COMM_WORLD, 0, free - 1, &right);
    HYPRE_IJVectorCreate(MPI_COMM_WORLD, 0, free - 1, &solution);
    HYPRE_IJMatrixSetObjectType(matrix, HYPRE_PARCSR);
    HYPRE_IJVectorSetObjectType(right, HYPRE_PARCSR);
    HYPRE_IJVectorSetObjectType(solution, HYPRE_PARCSR);
    HYPRE_IJMatrixInitialize(matrix);
    HYPRE_IJVectorInitialize(right);
    HYPRE_IJVectorInitialize(solution);
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (number[i] < 0) {
            continue;
        }
        HYPRE_BigInt columns[5] = {number[i]};
        double entries[5] = {0.0};
        HYPRE_Int used = 1;
        double sum = 0.0;
        auto const couple = [&](bool is_inside, std::size_t other) {
            if (!is_inside) {
                return;
            }
            entries[0] += 1.0;
            if (number[other] < 0) {
                sum += static_cast<double>(values[other]);
            } else {
                columns[used] = number[other];
                entries[used++] = -1.0;
            }
        };
        couple(i % side > 0, i - 1);
        couple(i % side + 1 < side, i + 1);
        couple(i >= side, i - side);
        couple(i + side < values.size(), i + side);
        double const zero = 0.0;
        HYPRE_IJMatrixSetValues(matrix, 1, &used, &number[i], columns, entries);
        HYPRE_IJVectorSetValues(right, 1, &number[i], &sum);
        HYPRE_IJVectorSetValues(solution, 1, &number[i], &zero);
    }
    HYPRE_IJMatrixAssemble(matrix);
    HYPRE_IJVectorAssemble(right);
    HYPRE_IJVectorAssemble(solution);
    HYPRE_ParCSRMatrix a;
    HYPRE_ParVector b;
    HYPRE_ParVector x;
    HYPRE_IJMatrixGetObject(matrix, reinterpret_cast<void**>(&a));
    HYPRE_IJVectorGetObject(right, reinterpret_cast<void**>(&b));
    HYPRE_IJVectorGetObject(solution, reinterpret_cast<void**>(&x));
    peer::measure(
        "hypre", side, 1, [] { return 0; },
        [&](int) {
            HYPRE_Solver amg;
            HYPRE_BoomerAMGCreate(&amg);
            HYPRE_BoomerAMGSetMaxIter(amg, 1);
            HYPRE_BoomerAMGSetTol(amg, 0.0);
            HYPRE_Solver cg;
            HYPRE_ParCSRPCGCreate(MPI_COMM_WORLD, &cg);
            HYPRE_ParCSRPCGSetTol(cg, 1e-6);
            HYPRE_ParCSRPCGSetMaxIter(cg, 200);
            HYPRE_PCGSetTwoNorm(cg, 1);
            HYPRE_ParCSRPCGSetPrecond(cg, HYPRE_BoomerAMGSolve, HYPRE_BoomerAMGSetup, amg);
            HYPRE_ParCSRPCGSetup(cg, a, b, x);
            HYPRE_ParCSRPCGSolve(cg, a, b, x);
        });
    HYPRE_Finalize();
    MPI_Finalize();
}
